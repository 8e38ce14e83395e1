"""The entry points of the page "Python API": each has an example, and the example is true."""

from __future__ import annotations

import ast
import doctest
import importlib.util
import inspect
import pickle
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import resolve_name

import pytest

import hearth

ROOT = Path(__file__).resolve().parents[2]


def page():
    """The hook that makes the page, without the fixture: tests are named for what it lists."""
    spec = importlib.util.spec_from_file_location("pages", ROOT / "docs/hooks/pages.py")
    loaded = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(loaded)
    return loaded


PAGE = page()
PLACES = [place for places in PAGE.ENTRY_POINTS.values() for place in places]


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    """The folder that examples run in, and what they have at hand."""
    folder, names = tmp_path_factory.mktemp("api"), {}
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        exec(PAGE.PREPARED, names)
        names["folder"] = names["folder"].resolve()
    return folder, names


@pytest.mark.parametrize("place", PLACES)
def test_the_example_is_true(place, prepared, monkeypatch):
    if place in ("hearth:render", "hearth:record"):
        pytest.importorskip("open3d", reason="rendering needs open3d")
    folder, names = prepared
    monkeypatch.chdir(folder)
    names["env"].reset("maple")
    example = doctest.DocTestParser().get_doctest(PAGE.documented(place)[1], dict(names), place, None, None)
    assert example.examples, "no example in the docstring"
    printed = []
    doctest.DocTestRunner().run(example, out=printed.append)
    assert not printed, "".join(printed)


def test_thirty_and_more_have_examples_and_stand_on_the_page_once():
    assert len(PLACES) == len(set(PLACES)) >= 30
    text = PAGE.python_api()
    for place in PLACES:
        about, example = PAGE.documented(place)
        name = place.rpartition(":")[2].rpartition(".")[2]
        assert text.count(f"\n### {place.replace(':', '.')}\n") == 1
        assert about and 1 < example.count(">>>") + example.count("\n") + 1 <= 12, place
        assert name.lower() in example.lower(), "the example does not use it"


def test_signatures_name_what_the_code_names():
    assert PAGE.signature("hearth:Env").endswith("partial: bool=True, knowledge: Knowledge | None=None)")
    assert PAGE.signature("hearth:run") == "run(world: World, program: Program, rules: Rules=DEFAULT) -> Execution"
    assert PAGE.signature("hearth:Dataset.sql") == "Dataset.sql(query: str, **parameters: Any) -> Any"
    assert PAGE.signature("hearth:World") == "class World"
    assert not any(" at 0x" in PAGE.signature(place) for place in PLACES)


def test_every_example_of_the_code_is_tested():
    """A docstring with an example that no test runs would go stale."""
    found = (inspect.unwrap(each) for each in map(resolve_name, PLACES) if callable(each))
    shown = {Path(inspect.getsourcefile(each)).resolve() for each in found}  # installed as a link, in a copy
    rooms = {path.parent for path in ROOT.glob("*/__init__.py")}
    files = (path for room in rooms for path in room.rglob("*.py"))
    assert {path.resolve() for path in files if "    >>> " in path.read_text()} <= shown


def test_what_hearth_has_is_what_type_checkers_see():
    tree = ast.parse((ROOT / "__init__.pyi").read_text())
    imports = [node for node in tree.body if isinstance(node, ast.ImportFrom)]
    seen = {alias.asname: node.module for node in imports for alias in node.names if alias.asname}
    assert seen == hearth._modules() and len(seen) > 25
    rooms = {path.name for path in ROOT.iterdir() if path.is_dir()}
    assert not rooms & (seen.keys() | {"load", "knowledge", "home", "parse_program", "attach"}) - {"build"}
    for name, module in seen.items():
        assert getattr(hearth, name).__name__ == name
        value = getattr(hearth, name)
        own = value if isinstance(value, type) else value.__wrapped__
        assert name == "Env" or own is getattr(import_module(module), name)
        assert pickle.loads(pickle.dumps(value)) is value
    defined = {node.name: ast.unparse(node.args) for node in tree.body if isinstance(node, ast.FunctionDef)}
    written = ast.parse((ROOT / "__init__.py").read_text()).body
    functions = {node.name: ast.unparse(node.args) for node in written if isinstance(node, ast.FunctionDef)}
    assert defined == {name: arguments for name, arguments in functions.items() if not name.startswith("_")}
    with pytest.raises(AttributeError, match="has no attribute `runs`"):
        _ = hearth.runs


def test_completion_has_the_entry_points_and_nothing_else():
    stub = (ROOT / "__init__.pyi").read_text()
    assert hearth.__all__ == sorted({*hearth._modules(), "load", "knowledge", "home", "parse_program", "attach"})
    assert all(name in stub and getattr(hearth, name) for name in hearth.__all__)
    assert {"Env", "run", "build", "bind", "World", "load", "__version__"} <= {*dir(hearth)} >= {*hearth.__all__}
    assert not {"Any", "lru_cache", "annotations", "explained", "VERSION", "TYPE_CHECKING"} & {*dir(hearth)}
    rest = {name for name in dir(hearth) if not name.startswith("__")} - {*hearth.__all__}
    assert rest <= {path.name for path in ROOT.iterdir() if path.is_dir()} | {"version", "cli", "old_names"}


def test_a_star_imports_the_entry_points():
    names = {}
    exec("from hearth import *", names)
    assert names.keys() - {"__builtins__"} == {*hearth.__all__}


def test_import_hearth_stays_light():
    code = "import sys, hearth; hearth.__version__; print(*sorted(m for m in sys.modules if m.startswith('hearth.')))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown.split() == ["hearth.old_names", "hearth.schemas", "hearth.schemas.call_errors", "hearth.version"]


def test_an_environment_has_our_knowledge_or_another():
    from hearth.simulation.env import Env

    assert hearth.Env().knowledge is hearth.knowledge()
    assert issubclass(hearth.Env, Env) and pickle.loads(pickle.dumps(hearth.Env)) is hearth.Env
    other = hearth.knowledge().__class__
    assert hearth.Env(knowledge=other).knowledge is other


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (lambda: hearth.home("mapel"), "UNKNOWN_HOME"),
        (lambda: hearth.parse_program(""), "EMPTY"),
        (lambda: hearth.parse_program("[Fly]\n[Walk] <fridge"), "2:8: SYNTAX"),
        (lambda: hearth.Env().reset("mapel"), "UNKNOWN_HOME"),
        (lambda: hearth.load("nowhere"), "MISSING_FILE"),
    ],
)
def test_bad_input_is_one_kind_of_error(call, code):
    with pytest.raises(hearth.schemas.diagnostics.HearthError, match=code):
        call()
