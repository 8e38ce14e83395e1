"""Expressions of the model files: numbers, names and calls, written as in Python, checked before they are compiled."""

from __future__ import annotations

import ast
import difflib
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from types import CodeType
from typing import Any, TypeAlias

import yaml

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

Node: TypeAlias = "str | list[Node] | dict[str, Node]"
"""A YAML value whose scalars are text."""
Values = dict[str, object]
"""Values by name."""

MATH: Values = {
    "__builtins__": {},
    **{f.__name__: f for f in (abs, enumerate, int, len, max, min, range, reversed, round, sorted, tuple, zip)},
    **{f.__name__: f for f in (math.cos, math.exp, math.sin)},
    "pi": math.pi,
}
"""Names that every expression may use."""
ALLOWED = (
    ast.expr_context, ast.operator, ast.unaryop, ast.boolop, ast.cmpop, ast.comprehension, ast.keyword, ast.Starred,
    ast.Constant, ast.Name, ast.Tuple, ast.List, ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.Call,
    ast.Subscript, ast.Slice, ast.ListComp, ast.GeneratorExp, ast.JoinedStr, ast.FormattedValue,
)  # fmt: skip
"""Syntax of expressions. Attributes are not allowed, so that only the given names can be reached."""


@dataclass(frozen=True, slots=True)
class Scope:
    """The place of an expression, for errors, and the names it may use.

    Attributes:
        file: of the model.
        model: its name.
        known: names that have a value.
        key: within the model.
    """

    file: str
    model: str
    known: frozenset[str]
    key: str = ""

    def at(self, key: str) -> Scope:
        """Return the scope of the value under `key`."""
        return replace(self, key=key)

    def knowing(self, names: Iterable[str]) -> Scope:
        """Return the scope with further names."""
        return replace(self, known=self.known | set(names))

    def fault(self, message: str, suggestion: str = "") -> HearthError:
        """Return an error that names this place."""
        where = ": ".join(part for part in (self.model, self.key) if part)
        return HearthError.of(Code.BAD_TABLE, f"{where}: {message}", file=self.file, suggestion=suggestion)

    def expression(self, node: Node) -> Expression:
        """Return the compiled expression of a text; lists become tuples.

        Raises:
            HearthError: its syntax is not allowed, or it uses an unknown name.
        """
        text = _source(node)
        tree, found = self._parsed(text)
        # A comprehension within an expression binds its own names.
        needs = frozenset(part.id for part in found) - {n.id for n in found if isinstance(n.ctx, ast.Store)}
        for name in sorted(needs - self.known):
            near = difflib.get_close_matches(name, self.known, 1)
            raise self.fault(f"unknown name `{name}` in `{text}`", f"did you mean `{near[0]}`?" if near else "")
        return Expression(compile(tree, f"<{self.file}>", "eval"), needs, text, self.fault)

    def loop(self, node: Node) -> tuple[tuple[str, ...], Expression]:
        """Return the names bound by `k in range(3)`, `x, z in spots` or `i in a for k in b`, and the tuples of their
        values.

        Raises:
            HearthError: the text is not of that form.
        """
        try:
            found: ast.expr | None = ast.parse(f"[0 for {node}]", mode="eval").body
        except SyntaxError:
            found = None
        if not isinstance(found, ast.ListComp):
            raise self.fault(f"`{node}` is not a repetition", "write `for: k in range(3)`")
        names = [n.id for each in found.generators for n in ast.walk(each.target) if isinstance(n, ast.Name)]
        return tuple(names), self.expression(f"[({', '.join(names)},) for {node}]")

    def parameters(self, text: str) -> dict[str, Expression | None]:
        """Parameters written as `w, d, paint, inset=0`, with their defaults (None: required)."""
        try:
            found = ast.parse(f"lambda {text}: 0", mode="eval").body
        except SyntaxError as error:
            raise self.fault(f"`{text}` is not a list of parameters") from error
        assert isinstance(found, ast.Lambda)
        defaults = [self.expression(ast.unparse(default)) for default in found.args.defaults]
        names = [argument.arg for argument in found.args.args]
        return dict(zip(names, [*[None] * (len(names) - len(defaults)), *defaults], strict=True))

    def _parsed(self, text: str) -> tuple[ast.Expression, list[ast.Name]]:
        """Return the checked syntax tree of a text, and the names in it."""
        try:
            tree = ast.parse(text, mode="eval")
        except SyntaxError as error:
            raise self.fault(f"`{text}` is not an expression") from error
        names = []
        for part in ast.walk(tree.body):
            if isinstance(part, ast.Name):
                names.append(part)
            elif not isinstance(part, ALLOWED) or (isinstance(part, ast.Call) and not isinstance(part.func, ast.Name)):
                raise self.fault(f"{type(part).__name__} is not allowed in `{text}`")
        return tree, names


@dataclass(frozen=True, slots=True)
class Expression:
    """An expression, or a list of them, ready to be evaluated.

    Attributes:
        code: compiled.
        needs: the names it uses.
        text: its source.
        fault: makes an error that names its place.
    """

    code: CodeType
    needs: frozenset[str]
    text: str
    fault: Callable[[str], HearthError]

    def __call__(self, names: Values) -> Any:
        """Its value.

        Raises:
            HearthError: the evaluation fails, for example in a division by zero.
        """
        try:
            # Only checked syntax is evaluated, and `names` has no builtins.
            return eval(self.code, names)
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            raise self.fault(f"{error} in `{self.text}`") from error


def _source(node: Node) -> str:
    """Return the Python source of an expression or of nested lists of them, which become tuples.

    `#rrggbb` is a string.
    """
    if isinstance(node, list):
        return f"({''.join(f'{_source(part)}, ' for part in node)})"
    if isinstance(node, dict):
        return f"{{{', '.join(node)}}}"
    return repr(node) if node.startswith("#") else node.strip()


@cache
def text_of(package: str, file: str) -> str:
    """Return the text of a file of entries."""
    return (files(package) / file).read_text(encoding="utf-8")


@cache
def entries_of(package: str, file: str) -> dict[str, Any]:
    """Return the entries of a file, with scalars as text."""
    found: dict[str, Any] = yaml.load(text_of(package, file), getattr(yaml, "CBaseLoader", yaml.BaseLoader))
    return found


def shared_of(package: str, file: str, known: Values) -> Values:
    """Return the values of a file's entry `shared`, which all its entries can use besides `known`.

    Mappings are tables.
    """
    names, found = dict(known), Values()
    place = f"{package.removeprefix('hearth.').replace('.', '/')}/{file}"
    for name, node in entries_of(package, file).get("shared", {}).items():
        scope = Scope(place, "shared", frozenset(names), name)
        table = {key: scope.expression(value)(names) for key, value in node.items()} if isinstance(node, dict) else None
        found[name] = names[name] = scope.expression(node)(names) if table is None else table
    return found
