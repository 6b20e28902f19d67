"""Logs of runs, read with h5py, and with xarray, where they are installed."""

from __future__ import annotations

import importlib
from os import PathLike
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    import xarray
    from numpy.typing import NDArray

# Axes behind that of the frames, told by their lengths, which are those of these datasets of /model.
_AXES = {"nq": "coordinate_name", "nv": "dof_name", "body": "mass"}


class Log:
    """A log, format hagfish-log 1. `file` is the h5py.File; log["trajectory/q"] is a numpy array."""

    def __init__(self, path: str | PathLike[str]) -> None:
        self.file = _h5py().File(path, "r")
        if self.attribute("format") != "hagfish-log":
            raise ValueError(f"{path}: not a hagfish-log file")

    def __getitem__(self, name: str) -> NDArray[Any]:
        """All of a dataset, shape and unit as experiments/docs/reference/log_format.md says."""
        values: NDArray[Any] = self.file[name][()]
        return values

    def __enter__(self) -> Log:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self.file.close()

    def attribute(self, name: str) -> str:
        """A root attribute as text: status, scene, command, warnings, ..."""
        value = self.file.attrs[name]
        return value.decode() if isinstance(value, bytes) else str(value)

    @property
    def names(self) -> list[str]:
        """Paths of all datasets."""
        found: list[str] = []
        dataset = _h5py().Dataset
        self.file.visititems(lambda name, node: found.append(name) if isinstance(node, dataset) else None)
        return found

    @property
    def status(self) -> str:
        """running, complete, or failed: CAUSE"""
        return self.attribute("status")

    @property
    def time(self) -> NDArray[np.float64]:
        """(frames,) s"""
        return self["trajectory/time"]

    @property
    def phase(self) -> list[str]:
        """Name of the phase at each frame."""
        dataset = self.file["trajectory/phase"]
        names = {number: name for name, number in _h5py().check_enum_dtype(dataset.dtype).items()}
        return [names[int(number)] for number in dataset[()]]

    def array(self, name: str) -> xarray.DataArray:
        """A dataset along the frames with its axes named, its unit and its description."""
        import xarray  # of those who have it

        dataset = self.file[name]
        of_model = {axis: self.file["model/" + name] for axis, name in _AXES.items()}
        axes = {len(values): axis for axis, values in of_model.items()}
        dims: list[str] = []
        coordinates: dict[str, Any] = {}
        for k, length in enumerate(dataset.shape):
            if k == 0 and length == len(self.time):
                dims.append("time")
                coordinates["time"] = self.time
            elif k > 0 and length in axes:
                axis = axes[length]
                dims.append(axis)
                coordinates[axis] = range(length) if axis == "body" else of_model[axis].asstr()[()]
            else:
                dims.append(f"axis_{k}")
        attributes = {key: dataset.attrs[key] for key in ("unit", "description") if key in dataset.attrs}
        return xarray.DataArray(dataset[()], dims=dims, coords=coordinates, name=name, attrs=attributes)


def _h5py() -> Any:
    """Imported where a log is read, so that runs do not need it."""
    try:
        return importlib.import_module("h5py")
    except ImportError as error:
        raise ImportError(f"hagfish.Log needs h5py (Debian's python3-h5py), which cannot be imported: {error}") from error
