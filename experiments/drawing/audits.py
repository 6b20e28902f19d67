"""Verdicts of `hagfish check --csv`: a script has no bounds of its own."""

import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

from hagfish_log import LogError
from script import HAGFISH
from tables import read_csv

COLUMNS = ["log", "criterion", "value", "bound", "unit", "met"]


@dataclass(frozen=True)
class Finding:
    """What was judged of a log; value and bound are numbers, or words where it is those that are compared."""

    criterion: str
    value: str  # empty where the run has no such figure
    bound: str
    unit: str
    met: bool


def read_findings(path: Path) -> list[Finding]:
    """The findings on one log, in the order of the audit."""
    rows = read_csv(path, COLUMNS)
    if len({row["log"] for row in rows}) > 1:
        raise LogError(f"{path}: covers several logs, but must be of one")
    return [Finding(row["criterion"], row["value"], row["bound"], row["unit"], row["met"] == "yes") for row in rows]


def audit(log: Path) -> list[Finding]:
    """By the program as built (HAGFISH_PROGRAM)."""
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder) / "check.csv"
        subprocess.run([HAGFISH, "check", log, "--csv", table], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return read_findings(table)


def value_of(findings: list[Finding], criterion: str) -> float:
    """Value of a criterion that is a number; nan where the log has none."""
    return next((float(finding.value) for finding in findings if finding.criterion == criterion and finding.value), float("nan"))


def meets(findings: list[Finding], criterion: str) -> bool:
    """Whether the log was judged by it, and met it."""
    return any(finding.criterion == criterion and finding.met for finding in findings)


def unmet(findings: list[Finding]) -> list[str]:
    """Criteria that failed."""
    return [finding.criterion for finding in findings if not finding.met]
