"""A wave of the body that runs to the tail, as a curvature program, and a scene in which it drives the animal through a slit in a
row of poles, its head through at first, or in open water.

Usage: slit_wave.py ANGLE LENGTH PERIOD SHARE PROGRAM.csv SCENE.toml: of the tangent, rad; body lengths; s; width of the slit over
the body's, or the scene of `hagfish specimen` whose animal swims without a slit.
"""

from pathlib import Path

from script import run_script
from slit_scene import FLESH, POLE, THICKEST
from waves import wave_program

DURATION = 20.0  # s; in open water half of it
ROW, APART, WALL = 24, 0.55, 1.5  # poles to each side of the slit, which overlap; cm: between them; x of all


def main(angle: float, length: float, period: float, share: str, program: Path, scene: Path) -> None:
    swims = share.endswith(".toml")
    lasts = DURATION / 2 if swims else DURATION
    program.write_text(wave_program(angle, length, period, lasts), encoding="utf-8")
    poles = []
    for side, sign in (("left", 1), ("right", -1)):
        for j in range(0 if swims else ROW):
            y = sign * (float(share) * THICKEST / 2 + POLE + APART * j)
            poles.append(f'[[obstacle]]\nname = "{side} {j}"\nkind = "strand"\npoints = [[{WALL}, {y:.6f}, -9.0], [{WALL}, {y:.6f}, 9.0]]\nradius = {POLE}\n')
    scene.write_text(f'''base = "{share if swims else 'living_overhand_free'}"
title = "Wave without a knot{' in open water' if swims else ' through a slit'}"
clamp_head = false
wall.present = false
time.rule = "midpoint"
script.program = "{program.name}"
time.duration = {lasts}
time.until = "form"
controller.tighten_from = {lasts - 0.1}
guard.penetration = 0.8
expect.knot = ""
expect.types = []

{FLESH}
''' + "\n".join(poles), encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["ANGLE", "LENGTH", "PERIOD", "SHARE", "PROGRAM.csv", "SCENE.toml"], main)
