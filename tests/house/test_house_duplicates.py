"""No body of more than three statements stands twice: where two functions do the same, one of them is enough."""

import ast
import subprocess
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LEAST = 4
"""Statements, those within others counted and the docstring left out, from which a body is compared."""


def test_no_body_stands_twice():
    listed = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    files = [name for name in listed.stdout.split() if not name.startswith("tests/")]
    assert len(files) > 100
    assert twice({name: (ROOT / name).read_text() for name in files if (ROOT / name).exists()}) == []


def twice(sources):
    """The places of functions whose bodies are the same but for the names of their parameters and variables."""
    places = defaultdict(list)
    for file, text in sources.items():
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and (shown := shape(node)):
                places[shown].append(f"{file}:{node.lineno} {node.name}")
    return [found for found in places.values() if len(found) > 1]


def shape(function):
    """A body as text in which names of its own are numbered in the order of their appearance; "" for a short body."""
    body = function.body[ast.get_docstring(function) is not None :]
    nodes = [node for statement in body for node in ast.walk(statement)]
    if sum(isinstance(node, ast.stmt) for node in nodes) < LEAST:
        return ""
    own = {node.arg for node in ast.walk(function.args) if isinstance(node, ast.arg)}
    own |= {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    own |= {node.arg for node in nodes if isinstance(node, ast.arg)}
    numbers = {}

    def number(name):
        return f"name {numbers.setdefault(name, len(numbers))}" if name in own else name

    for node in nodes:
        if isinstance(node, ast.Name):
            node.id = number(node.id)
        elif isinstance(node, ast.arg):
            node.arg, node.annotation = number(node.arg), None
        elif isinstance(node, ast.AnnAssign):
            node.annotation = ast.Constant(None)
    return "\n".join(map(ast.dump, body))


ONE = """
def one(rows: list, least):
    '''Sums up.'''
    total = 0
    for row in rows:
        if row > least:
            total += row
    return total
"""


def test_other_names_of_variables_do_not_hide_it():
    other = ONE.replace("one", "two").replace("rows: list", "items").replace("row", "item").replace("Sums", "Adds")
    assert twice({"a.py": ONE, "b.py": other.replace("total", "found")}) == [["a.py:2 one", "b.py:2 two"]]


def test_other_functions_attributes_and_numbers_distinguish_them():
    for changed in (ONE.replace("> least", "> least + 1"), ONE.replace("+= row", "+= abs(row)"),
                    ONE.replace("total += row", "total += least")):  # fmt: skip
        assert twice({"a.py": ONE, "b.py": changed}) == []


def test_short_bodies_may_be_alike():
    short = "def one(rows):\n    total = sum(rows)\n    assert total\n    return total\n"
    assert twice({"a.py": short, "b.py": short}) == []
