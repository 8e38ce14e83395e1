"""The rules of the house that can be read off the code: what may import what, sizes, what is imported late."""

import ast
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

LAYERS = {
    "schemas": -1, "storage": 0, "kb": 1, "homes": 2, "simulation": 3, "grounding": 4, "repair": 5, "rendering": 5,
    "datasets": 6, "scoring": 7, "pipelines": 8, "models": 9, "agents": 10, "envs": 11, "llm": 12,
    "challenges": 13, "interop": 14, "analysis": 15, "studies": 16, "web": 17, "commands": 18,
}  # fmt: skip
"""Packages by layer: each may import those below it and itself."""

ANYWHERE = {"version", "data_raw"}
STAGES = ("ingest", "validate", "sample", "augment", "render", "publish")
HEAVY = {"open3d", "cv2", "pandas", "pyarrow", "duckdb", "matplotlib", "networkx", "scipy", "numpy", "yaml", "orjson",
         "torch"}  # fmt: skip

MODULES = sorted(path for package in LAYERS for path in (ROOT / package).rglob("*.py"))
NAMES = [path.relative_to(ROOT).as_posix() for path in MODULES]


def imported(path):
    """Every `hearth.*` module that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            if node.module == "hearth":
                yield from (f"hearth.{alias.name}" for alias in node.names)
            elif node.module.startswith("hearth."):
                yield node.module
                yield from (f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name.startswith("hearth."))


def allowed(package, other):
    return other in ANYWHERE or other == package or LAYERS.get(other, 99) < LAYERS[package]


def test_there_is_something_to_look_at():
    assert len(MODULES) > 50
    assert {path.relative_to(ROOT).parts[0] for path in MODULES} <= set(LAYERS)


@pytest.mark.parametrize("path", MODULES, ids=NAMES)
def test_imports_go_one_way(path):
    package = path.relative_to(ROOT).parts[0]
    wrong = {name for name in imported(path) if not allowed(package, name.split(".")[1])}
    assert not wrong, f"{package} may not import {sorted(wrong)}"


@pytest.mark.parametrize("stage", STAGES)
def test_stages_do_not_call_each_other(stage):
    others = {f"hearth.pipelines.{other}" for other in STAGES if other != stage}
    assert not others & set(imported(ROOT / f"pipelines/{stage}.py"))


@pytest.mark.parametrize("path", MODULES, ids=NAMES)
def test_functions_stay_short(path):
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.FunctionDef):
            length = node.end_lineno - node.lineno + 1
            assert length <= 60, f"{node.name} has {length} lines"


def test_help_imports_nothing_heavy():
    """`--help` is quick because it imports no heavy library; no stopwatch is needed."""
    code = (
        "import sys; sys.argv = ['hearth', '--help']\n"
        "from hearth import cli\n"
        "try: cli.main()\n"
        "except SystemExit: pass\n"
        f"print(sorted({HEAVY!r} & set(sys.modules)), len(sys.modules))"
    )
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown.splitlines()[-1].startswith("[] "), shown
    assert int(shown.split()[-1]) < 500


def test_every_package_is_in_the_wheel():
    """The explicit list of packages is complete: a folder with an `__init__.py` that it lacks is not installed."""
    listed = set(tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"])
    folders = {path.parent for package in [*LAYERS, "data_raw"] for path in (ROOT / package).rglob("__init__.py")}
    assert listed == {"hearth", *(f"hearth.{'.'.join(folder.relative_to(ROOT).parts)}" for folder in folders)}


@pytest.mark.parametrize("path", MODULES, ids=NAMES)
def test_no_record_is_made_of_names_alone(path):
    """`dict.fromkeys(NAMES) | row` and `{**dict.fromkeys(NAMES), **row}` are records in which columns may lack."""
    for node in ast.walk(ast.parse(path.read_text())):
        operands = [node.left, node.right] if isinstance(node, ast.BinOp) else []
        operands += node.values if isinstance(node, ast.Dict) else []
        for each in operands:
            made = isinstance(each, ast.Call) and ast.unparse(each.func) == "dict.fromkeys" and len(each.args) == 1
            assert not made, f"line {each.lineno}: say what the record holds"
