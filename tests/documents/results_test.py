"""Pages of results say what their tables say, and nothing by hand."""

import re
import shutil
import subprocess
import sys

import pytest

from pages import ROOT, paragraphs, plain

sys.path.insert(0, str(ROOT / "experiments/results"))
import results  # noqa: E402

NAMES = results.names()
# Words with digits that are no figures: knots, equations, figures and tables of the paper, eigenvalues of nothing.
NO_FIGURE = re.compile(r"\bRK4\b|\b\d_\d\b|\bEqs?\. ?\d+(?: (?:and|to) \d+)?|\b(?:Table|Figure) \d\b|\bO\(n\)|[A-Z]\. [A-Za-z]+\. [A-Za-z]+\. \d+[:\d, ]*")


@pytest.mark.parametrize("path", results.documents(), ids=lambda path: path.parent.name)
def test_each_table_is_its_csv(path):
    assert results.rendered(path) == path.read_text(encoding="utf-8")


@pytest.mark.parametrize("name", NAMES)
def test_prose_has_no_figure_by_hand(name):
    for paragraph in paragraphs(results.VALUE.sub("figure", results.text_of(name))):
        words = NO_FIGURE.sub("", plain(paragraph))
        assert not re.search(r"\d", words), paragraph


@pytest.mark.parametrize("name", NAMES)
def test_a_page_says_what_its_knots_are_called(name):
    text = results.text_of(name)
    for knot, called in {"3_1": "overhand", "4_1": "figure-eight", "5_1": "double overhand", "5_2": "three-twist"}.items():
        assert not re.search(rf"\b{knot}\b", text) or f"{called} ({knot})" in text.lower(), knot


@pytest.mark.parametrize("name", NAMES)
def test_a_page_has_question_answer_command_and_limits(name):
    text = results.text_of(name)
    for part in ("**Answer.**", f"<!-- stamp: {name} -->", "## What this page does not show"):
        assert part in text
    assert results.question_of(name).endswith("?")


@pytest.mark.parametrize("name", NAMES)
def test_each_table_says_where_it_was_measured(name):
    assert results.tables_of(name)
    for path in results.tables_of(name):
        assert any(results.MEASURED.match(note) for note in results.read_table(path).notes), path.name


# Columns of what failed, where nothing did.
EMPTY = {("living_claims.csv", "what else became of it"), ("stability_starts.csv", "otherwise")}


@pytest.mark.parametrize("name", NAMES)
def test_no_column_is_empty(name):
    for path in results.tables_of(name):
        table = results.read_table(path)
        for heading, *cells in zip(table.head, *table.rows):
            assert any(cell not in ("", "-") for cell in cells) or (path.name, heading) in EMPTY, (path.name, heading)


@pytest.mark.parametrize("name", NAMES)
def test_each_csv_of_a_page_is_shown(name):
    there = {path.name for path in (results.RESULTS / name).glob("*.csv")}
    assert there == {*(table for table in results.shown_by(name) if "/" not in table), *results.settings_of(name).get("data", ())}


@pytest.mark.parametrize("name", NAMES)
def test_each_page_has_its_study_and_figures_and_is_listed(name):
    folder = results.RESULTS / name
    assert (folder / "study.sh").is_file()
    assert (results.RESULTS / "README.md").read_text(encoding="utf-8").count(f"]({name}/page.md)") == 1
    assert sorted(results.FIGURE.findall(results.text_of(name))) == sorted(path.name for path in folder.glob("*.png"))


@pytest.mark.parametrize("old, new, chance, same", [
    ("9.30", "9.35", 0.01, True), ("9.30", "9.9", 0.01, False), ("3_1", "4_1", 0.5, False), ("2e-14", "9e-14", 0.01, True),
    ("2e-14", "3e-7", 0.01, False), ("5 of 9", "5 of 8", 0.01, False), ("5 (energy gain)", "5 (limits)", 0.1, False), ("-0.5", "0.5", 0.1, False)])
def test_what_chance_leaves_open(old, new, chance, same):
    assert results.same(old, new, chance) == same


def test_differences_are_named():
    old = results.Table(["", "a"], [["x", "1"], ["y", "2"]])
    assert results.differences("t", old, results.Table(["", "a"], [["y", "2"], ["x", "1.05"]]), {"a": 0.1}) == []
    found = results.differences("t", old, results.Table(["", "a"], [["x", "2"], ["z", "2"]]), {"a": 0.1})
    assert found == ["t: x, a: was '1', is '2'", "t: a new row: z", "t: no row any more: y"]
    assert results.differences("t", old, results.Table(["", "b"], old.rows), {}) == ["t: columns were ['', 'a'], are ['', 'b']"]


def test_each_column_has_its_own_chance():
    table = lambda *cells: results.Table(["", "force, N", "starts", "CPU, s", "quickest"], [["x", *cells]])
    shares, old = {"^y; force": 0.9, "force": 0.1, "quick": float("inf")}, table("10", "5 of 8", "1", "a: 3")
    assert results.differences("t", old, table("10.9", "5 of 8", "9", "b"), shares) == []
    assert results.chance_of("y", "force, N", shares) == 0.9
    assert results.differences("t", old, table("11.2", "6 of 8", "9", "b"), shares) == [
        "t: x, force, N: was '10', is '11.2'", "t: x, starts: was '5 of 8', is '6 of 8'"]


@pytest.mark.parametrize("name", NAMES)
def test_chances_are_of_columns_that_there_are(name):
    for table, shares in results.settings_of(name).get("chance", {}).items():
        assert f"{table}.csv" in results.shown_by(name)
        read = results.read_table(results.RESULTS / name / f"{table}.csv")
        for row, _, heading in (pattern.rpartition("; ") for pattern in shares):
            assert any(re.search(heading, head) for head in read.head) and any(re.search(row, cells[0]) for cells in read.rows), (table, row, heading)


def test_only_code_makes_a_page_old():
    cpp = "int f();  // old words\n\n"
    assert results.without_comments("a.cpp", cpp) == results.without_comments("a.cpp", "// new\nint  f();\n")
    assert results.without_comments("a.cpp", cpp) != results.without_comments("a.cpp", "int g();\n")
    told = 'say("strands \\"meet\\" {}; " // why\n    "stop", x);'
    assert results.without_comments("a.cpp", told) == results.without_comments("a.cpp", 'say("halt", x);')
    assert results.without_comments("a.cpp", told) == results.without_comments("a.cpp", 'say(\n    "strands {}", x);')
    assert results.without_comments("a.cpp", told) != results.without_comments("a.cpp", 'say("halt", y);')
    assert results.without_comments("a.toml", 'a = "b"  # c\n') != results.without_comments("a.toml", 'a = "d"\n')


@pytest.fixture
def house(tmp_path, monkeypatch):
    """A project of one page, under version control."""
    (tmp_path / "experiments/results/p").mkdir(parents=True)
    (tmp_path / "core").mkdir()
    (tmp_path / "core/a.cpp").write_text("int a;\n")
    (tmp_path / "README.md").write_text("# R\n<!-- table: experiments/results/p/p.csv; rows: y -->\n<!-- end -->\n")
    (tmp_path / "experiments/results/p/page.toml").write_text('data = ["d.csv"]\n[chance]\np = { a = 0.1 }\n')
    (tmp_path / "experiments/results/README.md").write_text("# I\n<!-- index: p -->\n<!-- end -->\n")
    (tmp_path / "experiments/results/p/page.md").write_text("# Q?\n<!-- table: p.csv -->\n<!-- end -->\n<!-- stamp: p -->\n<!-- end -->\n")
    for name, path in (("ROOT", tmp_path), ("RESULTS", tmp_path / "experiments/results")):
        monkeypatch.setattr(results, name, path)
    git = lambda *words: subprocess.run(["git", "-C", tmp_path, "-c", "user.name=n", "-c", "user.email=e", *words], check=True, capture_output=True)
    git("init", "-q")
    git("add", ".")
    git("commit", "-qm", "one")
    return tmp_path


def test_a_figure_in_a_sentence_is_a_cell_of_its_table(house):
    page = house / "experiments/results/p/page.md"
    (house / "experiments/results/p/p.csv").write_text("a,b,c\nx,u,1.50 ± 0.1\nx,v,-2 (few)\ny,v,7\n")

    def said(of):
        page.write_text(f"By <!-- of: p.csv; {of} -->9<!-- end --> N.\n")
        return results.rendered(page)

    assert "-->1.50 ± 0.1<!--" in said("c; x + u")
    assert "-->-2 to 1.50<!--" in said("c; x")
    assert "-->-2 to 7<!--" in said("c")
    for of, why in (("d; x", "p/page.md: p.csv: no column 'd'"), ("c; z", "no number of 'c' in rows with")):
        with pytest.raises(results.LogError, match=why):
            said(of)


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_a_study_is_adopted_and_ages(house):
    page, csv = house / "experiments/results/p/page.md", house / "experiments/results/p/p.csv"
    commit = results.git("rev-parse", "HEAD").strip()
    (house / "s/tables").mkdir(parents=True)
    (house / "s/tables/p.csv").write_text(",a\nx,1\ny,2|3\n")
    (house / "s/tables/d.csv").write_text("b\n1\n")
    assert results.adopt("p", house / "s", "0.2.0 abcdef1", 61) == []
    assert "Other data: [d.csv](d.csv)." in page.read_text() and "abcdef1" in (house / "experiments/results/p/d.csv").read_text()
    assert "| y | 2\\|3 |" in page.read_text() and "took 1 min 1 s" in page.read_text()
    assert "| y | 2\\|3 |" in (house / "README.md").read_text() and "| x |" not in (house / "README.md").read_text()
    (house / "s/tables/p.csv").write_text(",a\nx,1.5\ny,2|3\n")
    (house / "s/tables/d.csv").write_text("b\n2\n")  # points of a figure: no claim
    assert results.adopt("p", house / "s", f"0.2.0 {commit}", 5) == ["p: x, a: was '1', is '1.5'"]
    results.mark()
    assert results.OLDER not in csv.read_text()
    (house / "core/a.cpp").write_text("int a;  // more words\n")
    results.mark()
    assert results.OLDER not in csv.read_text()
    (house / "core/a.cpp").write_text("int b;\n")
    results.mark()
    assert results.OLDER in csv.read_text() and results.OLDER in page.read_text()


@pytest.mark.skipif(shutil.which("git") is None, reason="needs git")
def test_code_that_moves_scenes_alike_ages_no_page(house, monkeypatch):
    program, csv = house / "digest", house / "experiments/results/p/p.csv"
    program.write_text('#!/bin/sh\necho "$1: $(cut -c1-5 ' + str(house / "core/a.cpp") + ') of 3 frames"\n')
    program.chmod(0o755)
    monkeypatch.setattr(results, "DIGESTS", house / "experiments/results/digests.csv")
    commit = results.git("rev-parse", "HEAD").strip()
    csv.write_text(f"# Measured at {commit} on a machine, 2026-01-01.\n,a\nx,1\ny,2\n")
    results.note_digests(program)
    old = lambda: results.mark() or results.OLDER in csv.read_text()
    (house / "core/a.cpp").write_text("int a; int b;\n")
    assert old()  # its digests are not known
    results.note_digests(program)
    assert not old()
    (house / "core/a.cpp").write_text("long a;\n")
    results.note_digests(program)
    assert old()  # other digests
    (house / "core/a.cpp").write_text("int a; int b;\n")
    (house / "data").mkdir()
    (house / "data/s.toml").write_text("other = 1\n")
    results.git("add", "data")
    assert old()  # no digest tells of scenes


def test_a_picture_says_where_it_was_measured(tmp_path):
    image = pytest.importorskip("PIL.Image")
    image.new("RGB", (4, 2), (10, 20, 30)).save(tmp_path / "a.png")
    results.take_figure(tmp_path / "a.png", tmp_path / "b.png", "Measured at abc.")
    with image.open(tmp_path / "b.png") as picture:
        assert picture.text["Comment"] == "Measured at abc."
        assert picture.size == (4, 2) and picture.convert("RGB").getpixel((3, 1)) == (10, 20, 30)


def test_bad_pages_are_told(house):
    with pytest.raises(results.LogError, match="No such file"):
        results.adopt("p", house, "0.2.0 abcdef1", 1)
    with pytest.raises(results.LogError, match="no page q"):
        results.settings_of("q")
    (house / "experiments/results/p/p.csv").write_text(",a\nx,1,2\n")
    with pytest.raises(results.LogError, match="3 cells under 2 headings"):
        results.render()
