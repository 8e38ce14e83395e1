"""No circle of files that import each other, be it at their top, inside a function or for type checkers only.

Each file can also be imported before all others: a package that is imported on the way runs its `__init__`.
"""

import ast
import subprocess
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def modules():
    """Module -> its file, of all that is ours: `hearth.schemas.graph` -> schemas/graph.py."""
    listed = subprocess.run(["git", "ls-files", "*.py"], cwd=ROOT, capture_output=True, text=True, check=True)
    found = {}
    for name in listed.stdout.split():
        path = ROOT / name
        if path.exists():
            parts = Path(name).with_suffix("").parts
            found[".".join(("hearth", *parts)).removesuffix(".__init__")] = path
    return found


def imports(source, known):
    """The modules of ours that a file imports, wherever in the file."""
    for node in ast.walk(ast.parse(source)):
        yield from imported_by(node, known)


def imported_by(node, known):
    """The modules of ours that a statement imports."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names if alias.name in known)
    elif isinstance(node, ast.ImportFrom) and node.module:
        named = {f"{node.module}.{alias.name}" for alias in node.names}
        yield from named & known
        if node.module in known and not named <= known:
            yield node.module


def packages(name):
    """Return the packages of a module, the outermost first."""
    parts = name.split(".")
    return {".".join(parts[:number]) for number in range(1, len(parts))}


def run_at_import(name, source, known):
    """Return the modules that run while a module is imported first: those it imports at its top, with their packages.

    The module's own packages have begun by then; so have those of the modules that one of them imports.
    """
    nodes, found = list(ast.parse(source).body), set()
    while nodes:
        node = nodes.pop()
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test):
            nodes += node.orelse
        elif isinstance(node, ast.Import | ast.ImportFrom):
            found |= set(imported_by(node, known))
        elif not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            nodes += [each for each in ast.iter_child_nodes(node) if isinstance(each, ast.stmt | ast.excepthandler)]
    return {each for module in found for each in {module, *packages(module)} & known} - packages(name) - {name}


def circle(sources, follow=lambda name, text, known: set(imports(text, known))):
    """The modules of one circle, or nothing."""
    known = set(sources)
    try:
        TopologicalSorter({name: follow(name, text, known) for name, text in sources.items()}).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_no_files_import_each_other_in_a_circle():
    found = circle({name: path.read_text() for name, path in modules().items()})
    assert not found, " -> ".join(reversed(found))


def test_each_module_can_be_imported_first():
    apart = ("hearth.tests.", "hearth.benchmarks.")
    ours = {name: path.read_text() for name, path in modules().items() if not name.startswith(apart)}
    found = circle(ours, run_at_import)
    assert not found, "whichever of these comes first fails: " + " -> ".join(reversed(found))


def test_a_circle_through_a_package_is_found():
    """`python -c "import hearth.a.one"` would fail: the package of `b.three` asks for `one`, which has just begun."""
    sources = {
        "hearth": "", "hearth.a": "", "hearth.a.one": "from hearth.a.b.three import more\nlisted = more",
        "hearth.a.b": "from hearth.a.b.two import listed", "hearth.a.b.two": "from hearth.a.one import listed",
        "hearth.a.b.three": "more = 1",
    }  # fmt: skip
    assert set(circle(sources, run_at_import)) == {"hearth.a.one", "hearth.a.b", "hearth.a.b.two"}
    assert not circle(sources)
    late = {**sources, "hearth.a.b.two": "def two():\n    from hearth.a.one import listed"}
    assert not circle(late, run_at_import)
    assert not circle({**sources, "hearth.a.b": ""}, run_at_import)


@pytest.mark.parametrize("back", [
    "import hearth.a.one",
    "def late():\n    from hearth.a import one",
    "if TYPE_CHECKING:\n    from hearth.a.one import thing",
])  # fmt: skip
def test_a_circle_is_found_however_it_is_imported(back):
    sources = {"hearth.a": "", "hearth.a.one": "from hearth.a.two import other", "hearth.a.two": back}
    assert set(circle(sources)) == {"hearth.a.one", "hearth.a.two"}
    assert not circle({**sources, "hearth.a.two": ""})
