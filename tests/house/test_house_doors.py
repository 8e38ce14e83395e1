"""What may be reached in one way only is reached so: DuckDB."""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
APART = {".venv", "tests", "benchmarks", "docs", "node_modules", "site"}
DOOR = "storage/databases.py"

SOURCES = sorted(path for path in ROOT.rglob("*.py") if not APART & {*path.relative_to(ROOT).parts})


def opened(path):
    """The lines in which a file calls DuckDB's module itself, or takes its functions out of it."""
    for node in ast.walk(ast.parse(path.read_text())):
        if (
            isinstance(node, ast.ImportFrom)
            and node.module == "duckdb"
            and any(not each.name[0].isupper() for each in node.names)
        ):
            yield node.lineno
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            owner = node.func.value
            if isinstance(owner, ast.Name) and owner.id == "duckdb" and node.func.attr != "tokenize":
                yield node.lineno


def test_duckdb_is_opened_in_one_place():
    found = {f"{path.relative_to(ROOT)}:{line}" for path in SOURCES for line in opened(path)}
    assert {place.partition(":")[0] for place in found} == {DOOR}, found
