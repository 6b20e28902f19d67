"""Scenes of study.sh, each kind with its grid: heads in holes of other widths, whose plates are rings about each other, and waves without a
knot at a head in a hole.

Usage: world_scenes.py FOLDER GRIDS. Leaves widths/ and waves/ in FOLDER; GRIDS has hole_map.toml, whose settings those of widths have.
"""

import json
import re
from pathlib import Path

from script import run_script
from waves import wave_program

DATA = Path(__file__).resolve().parents[3] / "data"
WIDTHS = (2, 3, 4, 5, 6, 7)  # cm
FACE, TUBE, RINGS = 2.0, 0.4, 4  # cm: x of the plate's face, a ring's radius; how many rings
# Of the tangent, rad; body lengths; s, in which the wave runs to the head once.
WAVES = ("0.5 0.6 0.25", "0.5 0.6 0.5", "0.5 0.6 1", "0.5 1 0.5", "0.5 1 1", "0.5 1 2", "1 1 1", "1 1 2")
PHASES = 8  # at the start
DURATION = 12.0  # s
HELD = 0.07  # of the length: what is in the hole stays straight


def ringed(text: str, width: float) -> str:
    """A scene of a head in a hole, of another width: each ring of the plate is a strand."""
    obstacles = [f'[[obstacle]]\nname = "plate"\nkind = "plane"\npoint = [{FACE}, 0.0, 0.0]\nnormal = [1.0, 0.0, 0.0]\nneck = "1 L"  # holds nothing\n']
    for ring in range(RINGS):
        obstacles.append(f'[[obstacle]]\nname = "ring {ring + 1}"\nkind = "ring"\ncentre = [{FACE - TUBE}, 0.0, 0.0]\naxis = [1.0, 0.0, 0.0]\n'
                         f'inner_radius = {width / 2 + 2 * TUBE * ring:g}\nradius = {TUBE}\n')
    before, behind = text.index("[[obstacle]]"), text.index("[controller]")
    return text[:before] + "\n".join([*obstacles, text[behind:]])


def main(folder: Path, grids: Path) -> None:
    files: dict[str, dict[str, str]] = {"widths": {}, "waves": {}}
    for width in WIDTHS:
        for knot in ("overhand", "figure_eight", "three_twist"):
            paper, reflex = ((DATA / f"{law}hole_{knot}.toml").read_text(encoding="utf-8") for law in ("", "reflex_"))
            files["widths"] |= {f"hole_{knot}_{width}.toml": ringed(paper, width), f"reflex_hole_{knot}_{width}.toml": re.sub(
                "(?m)^base = .*", f'base = "hole_{knot}_{width}.toml"', reflex)}
    for wave in WAVES:
        for eighth in range(PHASES):
            name = f"{wave.replace(' ', '_')}_{eighth}"
            program = wave_program(*map(float, wave.split()), DURATION, headward=True, held=HELD, phase=eighth / PHASES)
            files["waves"] |= {f"{name}.csv": program, f"{name}.toml": f'''base = "hole_overhand"
title = "{wave}"
script.program = "{name}.csv"
time.duration = {DURATION}
time.until = "form"
expect.knot = ""
expect.out_of = ""
expect.types = []
'''}
    settings = "".join(re.findall("(?m)^(?:keep|set) = .*\n", (grids / "hole_map.toml").read_text(encoding="utf-8")))
    heads = {"widths": f'{settings}[[axis]]\n"start.seed" = [1, 2, 3]\n', "waves": 'keep = "all"\n'}
    for kind, texts in files.items():
        (folder / kind).mkdir(exist_ok=True)
        scenes = json.dumps([name for name in texts if name.endswith(".toml")])
        for name, text in (texts | {"grid.toml": f"{heads[kind]}[[axis]]\nscene = {scenes}\n"}).items():
            (folder / kind / name).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["FOLDER", "GRIDS"], main)
