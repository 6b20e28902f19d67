"""Sweeps spread over jobs by Snakemake."""

import shutil
import subprocess

import pytest

from program import HAGFISH, ROOT, hagfish


@pytest.mark.skipif(shutil.which("snakemake") is None, reason="no snakemake here")
def test_a_grid_and_a_folder_may_have_spaces_in_their_names(tmp_path):
    (tmp_path / "g sp").mkdir()
    grid = 'scene = "table1"\nset = ["time.step=0.02", "time.duration=0.1"]\n[[axis]]\n"model.limit_scale" = [0.9, 1.0]\n'
    (tmp_path / "g sp/g.toml").write_text(grid)
    hagfish(tmp_path, "sweep", "g sp/g.toml", "--out", "alone")
    files = ["--snakefile", ROOT / "experiments/sweep/cluster/Snakefile"]
    settings = ["grid=g sp/g.toml", "out=my sweep", "parts=2", f"hagfish={HAGFISH}"]
    command = ["snakemake", "--cores", "2", "--quiet", *files, "--config", *settings]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "my sweep/table.csv").read_bytes() == (tmp_path / "alone/table.csv").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir() if path.name[0] != ".") == ["alone", "g sp", "my sweep"]
