"""Waves that run along the body, as curvature programs."""

import numpy as np

STATIONS, STEPS, RISE = 41, 16, 0.1  # along the body, in a period; of the length, over which the wave grows


def wave_program(angle: float, length: float, period: float, lasts: float, *, headward: bool = False, held: float = 0.0, phase: float = 0.0) -> str:
    """The CSV of a wave of the tangent: rad, body lengths, s, s. It grows within a period; the first `held` of the body stays straight;
    `phase` is a share of a period."""
    k, omega, turn = 2 * np.pi / length, (1 if headward else -1) * 2 * np.pi / period, 2 * np.pi * phase
    rows = ["time (s),station (L),bend_y (rad/L),bend_z (rad/L),twist (rad/L)"]
    for t in np.arange(0, lasts + 1e-9, period / STEPS):
        for s in np.linspace(0, 1, STATIONS):
            grown = min(1, t / period) * np.clip((s - held) / RISE, 0, 1)
            rows.append(f"{t:.5f},{s:.4f},0,{angle * k * grown * np.cos(k * s + omega * t + turn):.5f},0")
    return "\n".join(rows) + "\n"
