import csv

import hagfish
import pytest

import program

FAST = {"time.step": 0.01}


@pytest.fixture(scope="session")
def tied():
    """Where the knot of the Table 1 scene begins to slide. To be copied."""
    return hagfish.Simulation("table1", set=FAST).run(until="tighten")


@pytest.fixture
def sim():
    return hagfish.Simulation("table1", set=FAST)


@pytest.fixture(scope="session")
def refusal():
    """What the program says, beside its name, of arguments that it refuses."""

    def of(folder, *arguments):
        return program.hagfish(folder, *arguments, code=2).removeprefix("hagfish: ").removesuffix("\n")

    return of


@pytest.fixture(scope="session")
def findings():
    """Rows of `hagfish check` by their criterion."""

    def of(log):
        program.outcome(log.parent, "check", log, "--csv", log.with_suffix(".csv"), "--force")
        with log.with_suffix(".csv").open(newline="") as file:
            return {row["criterion"]: row for row in csv.DictReader(file)}

    return of


@pytest.fixture(scope="session")
def verdicts(findings):
    """Criteria that a log does not meet."""
    return lambda log: {name for name, row in findings(log).items() if row["met"] != "yes"}
