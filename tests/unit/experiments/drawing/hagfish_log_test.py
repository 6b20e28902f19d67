"""What cannot be read is said in one line; what is there is read as it is."""

import h5py
import numpy as np
import pytest

import taken
from hagfish_log import HagfishLog, LogError, Results
from program import script


def test_frames_are_those_that_every_dataset_holds(content, log):
    content.data["mean/forces/thigmotaxis"] = content.data["mean/forces/thigmotaxis"][:40]  # stopped while writing a frame
    short = log()
    assert short.frames == 40
    assert len(short["/knot/head_end"]) == len(short.labels("/trajectory/phase")) == 40
    assert len(short["/steps/kkt"]) == len(content.data["steps/kkt"])  # no frames


def test_phases_and_intervals(content, log):
    assert list(log().in_phase("slide")) == list(content.slide)
    assert list(log().intervals_in("slide")) == list(content.slide[1:])  # the first mean reaches back into tightening
    assert log().in_phase("reverse").size == 0


def test_a_run_that_starts_in_its_phase_has_no_mean_at_its_first_frame(content, log):
    content.data["trajectory/phase"][:] = 2
    assert log().intervals_in("slide")[0] == 1


def test_hinges_and_their_places(log):
    index, joint, kind = log().hinges()
    assert (index[0], joint[0], kind[0]) == (6, 1, "bend_z")
    assert (index[2], joint[2], kind[2]) == (8, 2, "twist")
    assert joint.max() == 40
    assert log().joint_arc()[5] == pytest.approx(5.0, rel=1e-12)  # rounding of a sum


@pytest.mark.parametrize("damage, words", [
    (lambda c: c.attributes.pop("format"), "no root attribute 'format'"),
    (lambda c: c.attributes.update(format="other"), "not a hagfish-log file"),
    (lambda c: c.attributes.update(format_version=2), "version 2"),
    (lambda c: c.data.update({name: values[:0] for name, values in c.data.items() if name[:5] not in ("model", "steps")}),
     "holds no frames")])
def test_a_foreign_or_empty_log_is_refused(content, log, damage, words):
    damage(content)
    with pytest.raises(LogError, match=words):
        log()


@pytest.mark.parametrize("what, by", [
    (b"SNOD", b"SNOX"),  # a group's members
    (b"TREE", b"TREX"),  # and chunks
    (b"HEAP", b"HEAX"),  # and names
    (b"[controller]", b"[controller."),  # no TOML
    (b"_bend_y", b"\xffbend_y")])  # no UTF-8
def test_a_damaged_log_is_one_line(log, what, by):
    path = log().path
    data = path.read_bytes()
    assert what in data
    path.write_bytes(data.replace(what, by))
    with pytest.raises(LogError) as told:
        damaged = HagfishLog(path)
        damaged.scene(), damaged.hinges(), damaged["/trajectory/time"]
    assert "\n" not in str(told.value) and path.name in str(told.value)


def test_missing_file_and_no_hdf5(tmp_path):
    with pytest.raises(LogError, match="no such file"):
        HagfishLog(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("text")
    for reader in (HagfishLog, Results):
        with pytest.raises(LogError, match="not a readable HDF5 file"):
            reader(tmp_path / "text.h5")


def test_a_dataset_that_is_no_enumeration_has_no_labels(content, log):
    with pytest.raises(LogError, match="not an enumeration"):
        log().labels("/knot/v2")


def test_a_missing_attribute_of_results_is_named(tmp_path):
    with h5py.File(tmp_path / "results.h5", "w") as file:
        file["time"] = np.arange(3.0)
    results = Results(tmp_path / "results.h5")
    assert list(results["/time"]) == [0, 1, 2]
    for ask in (lambda: results.attribute("motion"), lambda: results["/none"]):
        with pytest.raises(LogError):
            ask()


@pytest.mark.parametrize("missing", ["knot/head_end", "trajectory/phase", "mean/thigmotaxis/lambda"])
def test_a_script_says_which_dataset_is_missing_in_one_line(content, tmp_path, missing):
    del content.data[missing]
    path, outputs = content.write(tmp_path / "log.h5"), [tmp_path / "8.png", tmp_path / "c.png"]
    done = script("drawing/figure8.py", path, *outputs)
    assert (done.returncode, done.stderr) == (2, f"figure8.py: {path}: no dataset /{missing}\n")
    assert not any(output.exists() for output in outputs)


def steps_of(log):
    return {"steps": len(log["/steps/kkt"])}


def test_what_is_kept_of_logs_comes_in_the_order_of_their_numbers(content, tmp_path):
    for name in ("10", "9"):
        content.data["steps/kkt"] = np.zeros(int(name))
        content.write(tmp_path / f"{name}.h5")
    taken.main(f"{__name__}.steps_of", tmp_path)
    assert taken.taken(tmp_path) == [{"steps": 9}, {"steps": 10}]
    assert not list(tmp_path.glob("*.h5"))
