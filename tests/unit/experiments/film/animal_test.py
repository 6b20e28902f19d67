"""`hagfish animal`: a film of a body that is let go gives back the animal that it was made with."""

import pytest

from films import WITH, let_go
from program import hagfish, outcome, refused

FACTOR = {"stiffness EI": 0.5, "damping": 0.7, "drag": 1.6}


@pytest.fixture(scope="module")
def films(tmp_path_factory):
    folder = tmp_path_factory.mktemp("animal")
    for name, bend in (("letgo", 0.06), ("free", 0.06), ("still", 0.0)):
        let_go(folder, name, FACTOR, bend, name == "free")
    return folder


@pytest.mark.parametrize("film, options", [("letgo.csv", []), ("free.csv", ["--free-head"])])
def test_a_body_let_go_tells_its_animal(films, film, options):
    said = hagfish(films, "animal", film, *options, *WITH)
    for trait, true in FACTOR.items():
        line = next(line for line in said.splitlines() if line.startswith(f"{trait}: "))
        words = line.replace(",", "").split()
        low, high = float(words[words.index("to") - 1]), float(words[words.index("to") + 1])
        assert low <= true <= high, line
        assert high / low < 2, line


def test_a_stiff_body_that_beats_often_is_found(films):
    """All of its film at once fits best by a wrong number of beats."""
    let_go(films, "stiff", dict(zip(FACTOR, (4.83, 1.62, 0.627))), 0.06, False, 150, 16)
    said = hagfish(films, "animal", "stiff.csv", *WITH)
    assert float(said.split("stiffness EI: ")[1].split()[0]) == pytest.approx(4.83, rel=0.03)


def test_a_film_that_no_such_body_moves_like_is_refused(films):
    heading, *rows = (films / "letgo.csv").read_text().splitlines()
    backwards = [f"{2 - float(time):.6g},{rest}" for time, _, rest in (row.partition(",") for row in rows)]
    (films / "back.csv").write_text("\n".join([heading, *backwards]) + "\n")
    done = outcome(films, "animal", "back.csv", *WITH)
    assert done.returncode == 3 and "whose own shapes are within" in done.stdout


def test_an_animal_of_another_length_is_named(films):
    assert "its animal has 50 cm, that of table1 42.4 cm" in outcome(films, "animal", "still.csv", *WITH[:-1], 50, "--until", 0.5).stdout


def test_a_body_that_does_not_move_tells_nothing(films):
    said = outcome(films, "animal", "still.csv", *WITH).stdout
    assert said.count("the film does not tell") == 3


@pytest.mark.parametrize("scene, why", [("hole_overhand", "obstacles"), ("robot_overhand", "gravity")])
def test_scenes_with_other_forces_are_refused(films, scene, why):
    refused(films, "animal", "letgo.csv", "--scene", scene, parts=("letgo.csv", why))
