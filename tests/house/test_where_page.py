"""The page of limits and defaults has the values that the code has, and names places that exist."""

from __future__ import annotations

import ast
import re
import subprocess
from importlib import import_module
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs/where.md").read_text("utf-8")
ROWS = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in TEXT.splitlines() if line.startswith("| ")]
FACTS = [row for row in ROWS if row[2] != "place"]
UNITS = {"KiB": 2**10, "MiB": 2**20, "GiB": 2**30, "MB": 10**6}


def value_of(name, file):
    """Return the value of a constant, or of the default of a class's field."""
    found = import_module("hearth." + file.removesuffix(".py").replace("/", "."))
    owner, _, field = name.rpartition(".")
    return getattr(found, owner).__dataclass_fields__[field].default if owner else getattr(found, name)


def numbers(cell):
    """Return the numbers that a cell has, in their units."""
    return [
        float(number.replace(",", "")) * UNITS.get(unit, 1)
        for number, unit in re.findall(r"(\d(?:[\d.]|,(?=\d{3}))*) ?(\w*)", cell)
    ]


@pytest.mark.parametrize("row", [row for row in FACTS if " of `" in row[2]], ids=lambda row: row[0][:40])
def test_a_value_is_that_of_the_code(row):
    _, value, place = row
    *names, file = re.findall(r"`([^`]*)`", place)
    found = [value_of(name, file) for name in names]
    if value not in ("table", "all batch sizes"):
        flat = [each for one in found for each in (one if isinstance(one, tuple) else (one,))]
        assert numbers(value)[: len(flat)] == [float(each) for each in flat]


@pytest.mark.parametrize("row", FACTS, ids=lambda row: row[0][:40])
def test_a_place_exists(row):
    for name in re.findall(r"`([\w/.*]+\.(?:py|yaml|csv))`", row[2]):
        assert list(ROOT.glob(name)), name


def test_values_of_data_are_theirs():
    assert "\nticks: 250\n" in (ROOT / "challenges/wah.yaml").read_text("utf-8")


def test_every_variable_that_the_code_reads_is_listed():
    listed = subprocess.run(["git", "ls-files", "*.py", "*.yaml"], cwd=ROOT, capture_output=True, text=True, check=True)
    files = [name for name in listed.stdout.split() if not name.startswith(("tests/", "benchmarks/", "docs/"))]
    read = {name for file in files for name in re.findall(r"\bHEARTH_[A-Z_]+\b", (ROOT / file).read_text("utf-8"))}
    assert read - {"HEARTH_REPLAY"} <= {row[0].strip("`") for row in FACTS}  # the one left out is of a page's script


def test_the_time_limit_of_a_command_is_one_of_the_constants():
    """No command has a number of its own for `--within`."""
    for file in (ROOT / "commands").glob("*.py"):
        for node in ast.walk(ast.parse(file.read_text("utf-8"))):
            if isinstance(node, ast.arguments):
                defaults = zip(reversed(node.args), reversed(node.defaults), strict=False)
                assert not [1 for argument, default in defaults
                            if argument.arg == "within" and isinstance(default, ast.Constant)], file  # fmt: skip
