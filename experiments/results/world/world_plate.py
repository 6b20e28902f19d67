"""A scene of a head in a hole of another width: its plate is rings about each other, each a strand.

Usage: world_plate.py WIDTH SCENE.toml OUT.toml: of the hole, cm.
"""

from pathlib import Path

from script import run_script

FACE, TUBE, RINGS = 2.0, 0.4, 4  # cm: x of the plate's face, a ring's radius; how many rings


def main(width: float, scene: Path, out: Path) -> None:
    text = scene.read_text(encoding="utf-8")
    obstacles = [f'[[obstacle]]\nname = "plate"\nkind = "plane"\npoint = [{FACE}, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]\nneck = "1 L"  # holds nothing\n']
    for ring in range(RINGS):
        inner = width / 2 + 2 * TUBE * ring
        obstacles.append(f'[[obstacle]]\nname = "ring {ring + 1}"\nkind = "ring"\ncentre = [{FACE - TUBE}, 0.0, 0.0]\naxis = [1.0, 0.0, 0.0]\n'
                         f'inner_radius = {inner:g}\nradius = {TUBE}\n')
    before, behind = text.index("[[obstacle]]"), text.index("[controller]")
    out.write_text(text[:before] + "\n".join([*obstacles, text[behind:]]), encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["WIDTH", "SCENE.toml", "OUT.toml"], main)
