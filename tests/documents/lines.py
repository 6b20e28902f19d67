"""Lines of code by part, comments and blank lines included: what CONTRIBUTING.md says. Prints its table."""

import re
import subprocess

from pages import ROOT

PARTS = {"core": "core/", "solvers, mujoco_ref": ("solvers/", "mujoco_ref/"), "experiments": "experiments/", "tests": "tests/", "all": ""}
CODE = re.compile(r"\.(cpp|hpp|h|in|py|pyi|js|mjs|html|css|sh|cmake)$|CMakeLists\.txt$")


def thousands() -> dict[str, float]:
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files"], check=True, capture_output=True, text=True).stdout.split()
    lines = {name: (ROOT / name).read_bytes().count(b"\n") for name in listed if CODE.search(name) and (ROOT / name).is_file()}
    return {part: sum(count for name, count in lines.items() if name.startswith(folders)) / 1000 for part, folders in PARTS.items()}


if __name__ == "__main__":
    print("| part | thousand lines |\n|---|---|")
    for part, count in thousands().items():
        print(f"| {part} | {count:.1f} |")
