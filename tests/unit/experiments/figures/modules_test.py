"""Scripts that draw refer to what the modules beside them have: a name that is gone would show only at the end of a long study."""

from __future__ import annotations

import ast
import importlib
from pathlib import Path

import pytest

FIGURES = Path(__file__).resolve().parents[4] / "experiments" / "figures"
MODULES = sorted(path.stem for path in FIGURES.glob("*.py"))


@pytest.mark.parametrize("name", MODULES)
def test_names_of_other_modules_exist(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(FIGURES))
    tree = ast.parse((FIGURES / f"{name}.py").read_text(encoding="utf-8"))
    imported = {alias.asname or alias.name: alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names if alias.name in MODULES}
    used = {(node.value.id, node.attr) for node in ast.walk(tree)
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in imported}
    gone = [f"{module}.{attribute}" for module, attribute in sorted(used) if not hasattr(importlib.import_module(imported[module]), attribute)]
    assert not gone
