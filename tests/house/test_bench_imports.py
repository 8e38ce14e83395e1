"""Benchmarks and attacks run seldom: what they import from Hearth is there all the same."""

import ast
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = sorted(path for folder in ("benchmarks", "tests/trust") for path in (ROOT / folder).glob("*.py"))


def imported(path):
    """Every (module, name) of `from hearth... import`, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "hearth":
            yield from ((node.module, alias.name) for alias in node.names)


def is_there(module, name):
    if hasattr(import_module(module), name):
        return True
    try:
        return bool(import_module(f"{module}.{name}"))
    except ModuleNotFoundError:
        return False


@pytest.mark.parametrize("path", SCRIPTS, ids=lambda path: path.stem)
def test_what_a_script_imports_is_there(path):
    found = list(imported(path))
    if any(module.startswith("hearth.models") for module, _ in found):
        pytest.importorskip("torch")
    assert not [f"{module}.{name}" for module, name in found if not is_there(module, name)]
