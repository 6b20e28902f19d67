"""A scene that begins with a knot that the reflex is to slide: tied by its program, at rest, without a head plate.

Usage: tied_knot.py HAGFISH OUT.toml
"""

import subprocess
from pathlib import Path

from hagfish_log import HagfishLog, LogError
from script import run_script

SCENE = "reflex_overhand"


def main(hagfish: Path, out: Path) -> None:
    log_path = out.with_suffix(".h5")
    done = subprocess.run([str(hagfish), "run", SCENE, "--set", "time.until=slide", "--set", "expect.types=[]", "--out", str(log_path),
                           "--force", "--quiet"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise LogError(done.stderr.strip())
    log = HagfishLog(log_path)
    start = log["/trajectory/q"][log.in_phase("slide")[0]].tolist()
    out.write_text(f'base = "{SCENE}"\ntitle = "The tied knot"\n[wall]\npresent = false\n[start]\nphase = "slide"\nq = {start}\n'
                   '[time]\nuntil = "slide"\nframe_interval = 0.1\n[expect]\ntypes = []\n', encoding="utf-8")


if __name__ == "__main__":
    run_script(__doc__, ["HAGFISH", "OUT.toml"], main)
