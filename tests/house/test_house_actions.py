"""Common traits of several actions are a group of the knowledge: no code keeps a list of their names."""

from __future__ import annotations

import ast
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

TABLES = (
    "simulation/arrays/instruction_table.py",
    "simulation/actions/",
    "simulation/motion/moves.py",
    "rendering/people/gestures.py",
)
"""The table of actions, that of the moves by metres, the kernel and the gesture of each action."""

MANY = 2


def listed(source: str, names: set[str]) -> Iterator[tuple[int, list[str]]]:
    """(line, names) of every set, list, tuple or dict written out with several names of actions."""
    for node in ast.walk(ast.parse(source)):
        elements: list[ast.expr | None] = []
        if isinstance(node, ast.Set | ast.List | ast.Tuple):
            elements = [*node.elts]
        elif isinstance(node, ast.Dict):
            elements = [*node.keys]
        elif isinstance(node, ast.BinOp):  # {"Walk"} | {"Run"}
            elements = [e for part in ast.walk(node) if isinstance(part, ast.Set) for e in part.elts]
        found = [e.value for e in elements if isinstance(e, ast.Constant) and e.value in names]
        if len(found) >= MANY:
            yield node.lineno, found


def files() -> list[str]:
    done = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    return [name for name in done.stdout.split() if not name.startswith(("tests/", "docs/", "benchmarks/", *TABLES))]


def test_no_code_lists_actions(knowledge):
    names = set(knowledge.actions)
    found = [
        f"{file}:{line}: {', '.join(actions)}"
        for file in files()
        for line, actions in listed((ROOT / file).read_text("utf-8"), names)
    ]
    assert not found, "make it a group (kb/action_groups.py, `groups:` in kb/data/actions.yaml):\n" + "\n".join(found)


@pytest.mark.parametrize(
    "source",
    [
        '{"Walk", "Run"}',
        'frozenset({"Walk", "Run", "Find"})',
        '("Walk", "Run", *more, "Find")',
        '{"Walk": 1, "Run": 2, **more, "Find": 3}',
        '{"Walk", "Run"} | {"Find"}',
    ],
)
def test_a_list_of_actions_is_seen(source, knowledge):
    assert list(listed(source, set(knowledge.actions)))


@pytest.mark.parametrize("source", ['("Walk",)', '("walk", "run", "find")', 'f("Walk", "Run", "Find")'])
def test_other_lists_are_let_pass(source, knowledge):
    assert not list(listed(source, set(knowledge.actions)))
