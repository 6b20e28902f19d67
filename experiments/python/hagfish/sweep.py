"""Many runs of a scene, by a law of your own where there is one: a row a run."""

from __future__ import annotations

import itertools
import multiprocessing
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import TYPE_CHECKING, Any

from ._core import InputError, Simulation, StepError

if TYPE_CHECKING:
    from ._core import _Law, _Until

Row = dict[str, Any]


def sweep(
    scene: str | PathLike[str],
    values: Mapping[str, Sequence[object]],
    *,
    law: Callable[[], _Law] | None = None,
    set: Mapping[str, object] | None = None,
    until: _Until = None,
    figures: Callable[[Simulation], Mapping[str, object]] | None = None,
    processes: int = 1,
) -> list[Row]:
    """Runs `scene` with every combination of `values`, keys of the scene and what each shall be, besides those of `set`.

    `law`: a class or function that makes a control law for each run, called without arguments, so that no run sees what
    another left. `until` as of Simulation.run. A row has the values, the outcome ("ok", as StepError has it, or "refused"
    for settings that contradict each other), `message`, `time` (s), `phase`, `knot`, what `figures` makes of the
    simulation, and `warnings`, what the run was warned of. Rows are in the order of
    itertools.product, the same for any number of `processes`.
    """
    keys = list(values)
    cells = [dict(zip(keys, cell, strict=True)) for cell in itertools.product(*values.values())]

    def run(index: int) -> Row:
        return _row(scene, cells[index], law, dict(set or {}), until, figures)

    if processes <= 1:
        return [run(k) for k in range(len(cells))]
    global _run
    _run = run
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        return pool.map(_run_of_parent, range(len(cells)), chunksize=1)


_run: Callable[[int], Row]


def _run_of_parent(index: int) -> Row:
    """What the process that forked this one would run: laws and figures need not be sent."""
    return _run(index)


def _row(
    scene: str | PathLike[str],
    cell: Row,
    law: Callable[[], _Law] | None,
    set: Row,
    until: _Until,
    figures: Callable[[Simulation], Mapping[str, object]] | None,
) -> Row:
    row: Row = {**cell, "outcome": "ok", "message": "", "time": None, "phase": None, "knot": None, "warnings": []}
    try:
        sim = Simulation(scene, set={**set, **cell}, law=law() if law else None)
    except InputError as error:
        return {**row, "outcome": "refused", "message": str(error)}

    def over(now: Simulation) -> bool:
        row["warnings"] += now.warnings
        if until is None:
            return False
        if callable(until):
            return bool(until(now))
        if isinstance(until, str):
            return _order(now.phase) > _order(until)
        return now.time > until - 0.5 * now.h  # a time is a product of steps: half of one is rounding

    try:
        sim.run(until=over)
    except StepError as error:
        row.update(outcome=error.outcome, message=str(error))
    row.update(time=sim.time, phase=sim.phase, knot=sim.knot)
    return {**row, **(figures(sim) if figures else {})}


def _order(phase: str) -> int:
    return ("form", "tighten", "slide", "pull", "reverse", "release", "free").index(phase)
