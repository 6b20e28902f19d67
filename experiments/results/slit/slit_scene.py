"""A scene with a slit of another width.

Usage: slit_scene.py SHARE BASE OUT.toml: width over the body's largest one; scene whose poles move.
"""

import math
from pathlib import Path

from script import run_script

THICKEST = 5.6 / math.pi  # cm: specimens/pacific_hagfish.toml
POLE = 0.3  # cm: radius
AT = {"slit": 44.0, "hole_overhand": 1.7}  # cm: x of the poles
PLATE = '[[obstacle]]\nname = "plate"\nkind = "plane"\npoint = [2.0, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]\nneck = 3.0\n'
GUARD = "guard.penetration = 0.8\n"  # cm: flesh may overlap
FLESH = "[flesh]\nstiffness = 1e5\nrelaxation = 0.015\nspacing = 0.212\n"


def main(share: str, base: str, out: Path) -> None:
    y = float(share) * THICKEST / 2 + POLE
    poles = [f'[[obstacle]]\nname = "{side} pole"\nkind = "strand"\npoints = [[{AT[base]}, {sign * y:.6f}, -9.0], '
             f"[{AT[base]}, {sign * y:.6f}, 9.0]]\nradius = {POLE}\n" for side, sign in (("left", 1), ("right", -1))]
    plate = [PLATE] if base == "hole_overhand" else []
    title = f"Slit of {share} of the body's width"
    out.write_text("\n".join([f'base = "{base}"\ntitle = "{title}"\n', GUARD, FLESH, *plate, *poles]), encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["SHARE", "BASE", "OUT.toml"], main)
