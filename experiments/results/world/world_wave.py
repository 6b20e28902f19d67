"""A wave of the body that runs to the head, as a curvature program, and a scene in which it pulls at a head held in a hole.

Usage: world_wave.py ANGLE LENGTH PERIOD PHASE PROGRAM.csv SCENE.toml: of the tangent, rad; body lengths; s; at the start, turns.
"""

from pathlib import Path

import numpy as np

from script import run_script

DURATION = 12.0  # s
STATIONS, STEPS = 41, 16  # along the body, in a period
HELD, RISE = 0.07, 0.1  # of the length: what is in the hole stays straight, and over what the wave grows behind it


def main(angle: float, length: float, period: float, phase: float, program: Path, scene: Path) -> None:
    k, omega = 2 * np.pi / length, 2 * np.pi / period
    turn = 2 * np.pi * phase
    rows = ["time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)"]
    for t in np.arange(0, DURATION + 1e-9, period / STEPS):
        for s in np.linspace(0, 1, STATIONS):
            share = min(1, t / period) * np.clip((s - HELD) / RISE, 0, 1)
            rows.append(f"{t:.5f},{s:.4f},0,{angle * k * share * np.cos(k * s + omega * t + turn):.5f},0")
    program.write_text("\n".join(rows) + "\n", encoding="utf-8")
    scene.write_text(f'''base = "hole_overhand"
title = "Wave without a knot, head in a hole"
script.program = "{program.name}"
time.duration = {DURATION}
time.until = "form"
expect.knot = ""
expect.out_of = ""
expect.types = []
''', encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["ANGLE", "LENGTH", "PERIOD", "PHASE", "PROGRAM.csv", "SCENE.toml"], main)
