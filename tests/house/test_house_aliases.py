"""A name stands for one type: no two files give one name to a type, be it the same type or another."""

import ast
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("schemas", "kb", "simulation", "grounding", "rendering", "scoring", "pipelines", "exports", "report")

GENERIC = {
    "Callable", "Collection", "Counter", "Iterable", "Iterator", "Literal", "Mapping", "NDArray", "Sequence", "Set",
    "defaultdict", "dict", "frozenset", "list", "set", "tuple", "type",
}  # fmt: skip
"""The parts of types; options of commands, which are Annotated, are no names of types."""


def is_type(value):
    """Return whether an expression is a type: one with parameters, a choice of types, or a plain one."""
    if isinstance(value, ast.BinOp):
        return isinstance(value.op, ast.BitOr) and is_type(value.left)
    if isinstance(value, ast.Subscript):
        return isinstance(value.value, ast.Name) and value.value.id in GENERIC
    return isinstance(value, ast.Name) and value.id in {"bool", "bytes", "float", "int", "str"}


def aliases(source):
    """The names that a file gives to types."""
    for node in ast.parse(source).body:
        if isinstance(node, ast.Assign) and is_type(node.value):
            yield from (target.id for target in node.targets if isinstance(target, ast.Name))
        elif isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation).endswith("TypeAlias"):
            yield node.target.id


def repeated(sources):
    """Name -> the files that declare it, where there are several."""
    found = defaultdict(list)
    for file, source in sources.items():
        for name in aliases(source):
            found[name].append(file)
    return {name: files for name, files in found.items() if len(files) > 1}


def test_no_name_of_a_type_is_declared_in_two_files():
    files = [path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))]
    assert len(files) > 200
    assert not repeated({path.relative_to(ROOT).as_posix(): path.read_text() for path in files})


def test_names_that_are_declared_twice_are_found():
    sources = {
        "a.py": "Key = tuple[str, int]\nLIMITS = [3]\nFlag: TypeAlias = 'bool'\nfirst = table[0]\nMask = int",
        "b.py": "Key = Sequence[str] | None\nFlag = bool\nfirst = table[1]\ndef inside():\n    Mask = int",
    }
    assert repeated(sources) == {"Key": ["a.py", "b.py"], "Flag": ["a.py", "b.py"]}
