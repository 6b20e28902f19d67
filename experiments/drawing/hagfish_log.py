"""Read access to a `hagfish-log` (HDF5, format version 1) and to the HDF5 results of a study.

What is missing, unreadable, foreign or without frames is a LogError.
"""

import contextlib
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

FORMAT = "hagfish-log"
VERSION = 1
KINDS = ("twist", "bend_y", "bend_z")  # of hinges: about X, Y and Z
SINCE = ("/trajectory/curvature", "/mean/moments/thigmotaxis", "/mean/moments/active")  # version 0.3
FRAME_GROUPS = ("trajectory", "forces", "thigmotaxis", "mean", "muscle", "flesh", "pull", "knot", "diagnostics")


class LogError(Exception):
    """An input cannot be used; the message is one line that names the file."""


@contextlib.contextmanager
def reading(what: str) -> Iterator[None]:
    """Makes whatever h5py and numpy raise of damaged data a LogError."""
    try:
        yield
    except (OSError, RuntimeError, LookupError, ValueError, TypeError) as error:
        raise LogError(f"{what} cannot be read ({' '.join(str(error).split())})") from None


def open_hdf5(path: Path) -> h5py.File:
    if not path.is_file():
        raise LogError(f"{path}: no such file")
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise LogError(f"{path}: not a readable HDF5 file ({error})") from None


def dataset_of(file: h5py.File, path: str) -> h5py.Dataset:
    with reading(f"{file.filename}: {path}"):
        found = file.get(path)
    if not isinstance(found, h5py.Dataset):
        level = file.attrs.get("log_level", "full")
        why = f": made with --log {level}, but this script needs --log full" if level != "full" else ": make the run again, logs before 0.3 lack it" if path in SINCE else ""
        raise LogError(f"{file.filename}: no dataset {path}{why}")
    return found


def values_of(dataset: h5py.Dataset, rows: slice | tuple[()] = ()) -> np.ndarray:
    with reading(f"{dataset.file.filename}: {dataset.name}"):
        return dataset[rows]


class Results:
    """An open HDF5 file of a study (`hagfish compare`, `hagfish playback`): `results["/time"]` is an array."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._file = open_hdf5(path)

    def __getitem__(self, path: str) -> np.ndarray:
        return values_of(dataset_of(self._file, path))

    def attribute(self, name: str) -> Any:
        """A root attribute."""
        with reading(f"{self.path}: the root attribute '{name}'"):
            value = self._file.attrs.get(name)
            if value is None:
                raise LogError(f"{self.path}: no root attribute '{name}'")
            return value.decode() if isinstance(value, bytes) else value


class HagfishLog(Results):
    """An open log. `log["/knot/head_end"]` is the whole dataset as a numpy array.

    Datasets along time are cut to the frames that all of them hold, so that the log of a run that
    is still going, or was stopped while writing a frame, reads as the frames that are complete.
    """

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._read: dict[str, np.ndarray] = {}
        if self.attribute("format") != FORMAT:
            raise LogError(f"{path}: not a {FORMAT} file (its format is {self.attribute('format')!r})")
        with reading(f"{path}: the root attribute 'format_version'"):
            version = int(self.attribute("format_version"))
        if version != VERSION:
            raise LogError(f"{path}: {FORMAT} version {version}; this script reads version {VERSION}")
        with reading(f"{path}: its list of datasets"):
            self.frames = min((dataset.shape[0] for dataset in self._along_time()), default=0)
        if self.frames == 0:
            raise LogError(f"{path}: holds no frames (status: {self.attribute('status')})")

    def _along_time(self) -> list[h5py.Dataset]:
        """Every dataset with a row for each frame, those of nested groups (/mean/forces/...) too."""
        found: list[h5py.Dataset] = []
        take = lambda _, item: found.append(item) if isinstance(item, h5py.Dataset) else None
        for group in FRAME_GROUPS:
            if isinstance(self._file.get(group), h5py.Group):
                self._file[group].visititems(take)
        return found

    def __getitem__(self, path: str) -> np.ndarray:
        if path not in self._read:
            dataset = dataset_of(self._file, path)
            along_time = path.strip("/").split("/")[0] in FRAME_GROUPS
            self._read[path] = values_of(dataset, slice(self.frames) if along_time else ())
        return self._read[path]

    def strings(self, path: str) -> list[str]:
        """A dataset of strings, such as /model/dof_name."""
        with reading(f"{self.path}: {path}"):
            return [str(text) for text in dataset_of(self._file, path).asstr()[()]]

    def labels(self, path: str) -> np.ndarray:
        """An enumerated dataset along time as its words: /trajectory/phase, /diagnostics/solve."""
        with reading(f"{self.path}: {path}"):
            words = h5py.check_enum_dtype(dataset_of(self._file, path).dtype)
            if words is None:
                raise LogError(f"{self.path}: {path} is not an enumeration")
            by_value = {value: word for word, value in words.items()}
            return np.array([by_value[int(value)] for value in self[path]])

    def named(self, what: str, by: str) -> dict[str, str]:
        """One of /enumerations by another: what a phase is, a knot's name by its invariants."""
        keys, names = (self.strings(f"/enumerations/{name}") for name in (by, what))
        return dict(zip(keys, names))

    def knots(self, frames: np.ndarray) -> list[str]:
        """The knot's name at these frames; its invariants where they have none."""
        names = self.named("knot", by="knot_invariants")
        types = (f"det={d},v2={v}" for d, v in zip(self["/knot/determinant"][frames], self["/knot/v2"][frames]))
        return [names.get(type_, type_) for type_ in types]

    def in_phase(self, phase: str) -> np.ndarray:
        """Indices of the frames of one phase, one of /enumerations/phase."""
        return np.flatnonzero(self.labels("/trajectory/phase") == phase)

    def intervals_in(self, phase: str) -> np.ndarray:
        """Indices of the frames of one phase whose frame before, an interval before it, is of it too:
        their rows of /mean are means over steps of that phase alone."""
        frames = self.in_phase(phase)
        frames = frames[np.isin(frames - 1, frames)]
        since = np.diff(self["/trajectory/step"], prepend=0)
        # The state at the end may come sooner after the frame before.
        return frames[since[frames] == since[min(1, self.frames - 1)]] if frames.size else frames

    def begun(self) -> int:
        """Frames at which a step begins: all but the state at the run's end, of which forces, rows and
        residuals of a step are nan or 0."""
        step = self["/trajectory/step"]
        return self.frames - int(self.frames > 1 and step[-1] - step[0] == dataset_of(self._file, "/steps/kkt").shape[0])

    def scene(self) -> dict[str, Any]:
        """The resolved scene."""
        with reading(f"{self.path}: the root attribute 'scene'"):
            return tomllib.loads(self.attribute("scene"))

    def joint_arc(self) -> np.ndarray:
        """Arc length from the head of each joint at rest, cm (J): joint j is the front of body j."""
        length = self["/model/length"]
        return np.concatenate([[0.0], np.cumsum(length)[:-1]])

    def moments(self, force: str) -> np.ndarray:
        """Moment about each joint of one kind of force ("thigmotaxis", "active", ...), in axes halfway through it, frames x joints x 3,
        dyn cm: means since the frame before. It is the body's; torques of hinges (/mean/forces) are its parts along axes that take turns."""
        return self[f"/mean/moments/{force}"]

    def at_hinges(self, vectors: np.ndarray) -> np.ndarray:
        """Of vectors at joints (... x joints x 3) the part about the axis of each hinge's kind: X of twists, Y or Z of bends."""
        _, joint, kind = self.hinges()
        return vectors[..., joint, [KINDS.index(each) for each in kind]]

    def hinges(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Every velocity behind the root: (its index in qvel, its joint, its kind), where the kind
        is 'twist', 'bend_y' or 'bend_z'."""
        names = self.strings("/model/dof_name")
        index = np.array([i for i, name in enumerate(names) if not name.startswith("root")])
        with reading(f"{self.path}: /model/dof_name"):
            joint = np.array([int(names[i].split("_", 1)[0].lstrip("j")) for i in index])
            kind = np.array([names[i].split("_", 1)[1] for i in index])
        return index, joint, kind
