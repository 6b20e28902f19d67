"""Scripts that draw refer to what the modules beside them have: a name that is gone would show only at the end of a long study."""

import ast
import importlib
from pathlib import Path

import pytest

from conftest import EXPERIMENTS

FILES = sorted(path for folder in ("drawing", "results", "results/*") for path in EXPERIMENTS.glob(f"{folder}/*.py"))
MODULES = [path.stem for path in FILES]


def test_no_two_modules_have_one_name() -> None:
    assert len(set(MODULES)) == len(MODULES)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_module_gives_each_name_once(path: Path) -> None:
    body = ast.parse(path.read_text(encoding="utf-8")).body
    targets = [target for line in body if isinstance(line, (ast.Assign, ast.AnnAssign)) for target in getattr(line, "targets", None) or [line.target]]
    assigned = [name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)]
    names = assigned + [line.name for line in body if isinstance(line, (ast.FunctionDef, ast.ClassDef))]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_names_of_other_modules_exist(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    imported = {alias.asname or alias.name: alias.name for node in ast.walk(tree) if isinstance(node, ast.Import)
                for alias in node.names if alias.name in MODULES}
    used = {(node.value.id, node.attr) for node in ast.walk(tree)
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in imported}
    gone = [f"{module}.{attribute}" for module, attribute in sorted(used) if not hasattr(importlib.import_module(imported[module]), attribute)]
    assert not gone
