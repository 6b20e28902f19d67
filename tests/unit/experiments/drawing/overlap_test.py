"""Which of MuJoCo's settings is quoted beside the core's, and by how much it is dearer."""

import pytest

from hagfish_log import LogError
from overlap import quickest, table


def row(simulator: str, overlap: float, cpu: float, h: float = 1) -> dict[str, str]:
    return {"bodies": "50", "simulator": simulator, "h_ms": f"{h}", "constant_ms": "4", "share": "0.9",
            "overlap_cm": f"{overlap}", "limits_deg": "0.5", "cpu_s": f"{cpu}"}


def test_the_quickest_within_the_bound_is_quoted() -> None:
    rows = [row("mujoco", 0.01, 0.1), row("mujoco", 0.002, 0.5, 7), row("mujoco", 0.001, 0.8)]
    assert quickest(rows, 0.0025) == rows[1]
    assert quickest(rows, 0.0005) is None


def test_ratios_are_over_the_quickest_step_of_the_core() -> None:
    rows = table([row("core", 0.0004, 0.02), row("core", 0.0001, 0.08), row("mujoco", 0.002, 0.5, 7)])
    assert ["50", "0.0025", "25.0", "7"] in [cells[:4] for cells in rows]
    assert ["50", "0.0004", "none does"] in [cells[:3] for cells in rows]


def test_rows_of_the_core_are_wanted() -> None:
    with pytest.raises(LogError, match="no row of the core with 50 bodies"):
        table([row("mujoco", 0.002, 0.5)])
