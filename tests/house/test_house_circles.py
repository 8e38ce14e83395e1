"""No circle of files that import each other, be it at their top, inside a function or for type checkers only."""

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
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom) and node.module:
            named = {f"{node.module}.{alias.name}" for alias in node.names}
            yield from named & known
            if node.module in known and not named <= known:
                yield node.module


def circle(sources):
    """The modules of one circle, or nothing."""
    known = set(sources)
    try:
        TopologicalSorter({name: set(imports(text, known)) for name, text in sources.items()}).prepare()
    except CycleError as error:
        return error.args[1]
    return []


def test_no_files_import_each_other_in_a_circle():
    found = circle({name: path.read_text() for name, path in modules().items()})
    assert not found, " -> ".join(reversed(found))


@pytest.mark.parametrize("back", [
    "import hearth.a.one",
    "def late():\n    from hearth.a import one",
    "if TYPE_CHECKING:\n    from hearth.a.one import thing",
])  # fmt: skip
def test_a_circle_is_found_however_it_is_imported(back):
    sources = {"hearth.a": "", "hearth.a.one": "from hearth.a.two import other", "hearth.a.two": back}
    assert set(circle(sources)) == {"hearth.a.one", "hearth.a.two"}
    assert not circle({**sources, "hearth.a.two": ""})
