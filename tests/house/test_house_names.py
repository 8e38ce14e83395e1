"""Names that come with data become paths in one place: `inside` of storage/names.py."""

from __future__ import annotations

import ast
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

OURS = {
    "storage/partitions.py": 2,  # numbers of parts
    "storage/url_fetching.py": 1,  # the user's number, and a digest
    "storage/remote_build_folders.py": 1,  # the user's number
    "storage/duckdb_connections.py": 1,  # numbers of a process and its databases
}
"""The number of joins of a path and a made-up name in each file whose made-up names are numbers and digests of ours."""

STRICT = ("datasets/export/", "datasets/report/", "homes/home_export.py")
"""Files that write files for others: here no variable is joined to a path either."""


def joins(source: str, *, strict: bool) -> Iterator[int]:
    """The lines where a path is joined to a text with something put in, or, if strict, to a variable."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Div):
            variable = isinstance(node.right, ast.Name) and not node.right.id.isupper() and _like_a_path(node.left)
            if isinstance(node.right, ast.JoinedStr) or (strict and (variable or _of_data(node.right))):
                yield node.lineno


def _like_a_path(node: ast.expr) -> bool:
    if isinstance(node, ast.BinOp):
        return isinstance(node.op, ast.Div) and _like_a_path(node.left)
    return isinstance(node, ast.Name | ast.Attribute)


def _of_data(node: ast.expr) -> bool:
    """`row["file"]`, `run.home`."""
    return isinstance(node, ast.Subscript | ast.Attribute)


def files() -> list[str]:
    done = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in done.stdout.split() if not name.startswith(("tests/", "docs/", "benchmarks/"))]


def test_no_other_place_joins_names_of_data_to_paths():
    found = {}
    for name in files():
        lines = list(joins((ROOT / name).read_text("utf-8"), strict=name.startswith(STRICT)))
        if len(lines) != OURS.get(name, 0):
            found[name] = lines
    assert not found, f"use `inside` of storage/names.py: {found}"


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ('to / f"{name}.json"', True),
        ('to / "x" / row["file"]', True),
        ("to / run.home", True),
        ("root / name", True),
        ('to / "data"', False),
        ("root / ROOT", False),
        ("sum(each) / several", False),
    ],
)
def test_a_join_is_recognised(source, found):
    assert bool(list(joins(source, strict=True))) is found
