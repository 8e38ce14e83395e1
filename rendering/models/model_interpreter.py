"""Builds meshes from the entries of the model files.

An entry is read from top to bottom. `let` names quantities, paints and meshes; `for` repeats the rest of the entry;
`when` makes it conditional. Then comes one shape with its options, `parts` (several shapes), `either` (the first whose
`when` holds) or `use` (a named mesh), and then the moves `stretch`, `turn` and `shift`, in their order.
"""

from collections.abc import Callable, Sequence
from typing import TypeAlias, cast

from hearth.rendering.models.mesh import Mesh, empty, join, shift, stretch, turn
from hearth.rendering.models.model_expressions import Node, Scope, Values
from hearth.rendering.models.primitives import LINES, SHAPES

Build: TypeAlias = Callable[[Values], Mesh]
Draw: TypeAlias = Callable[[Values, Sequence[object], Values], Mesh]
"""(names of the look, values of the parameters in order, options by name) -> mesh."""
Find: TypeAlias = Callable[[str], "Draw | None"]

FACINGS = frozenset(("+x", "-x", "+y", "+z", "-z"))
"""Literal values of `facing`."""
LOOK = "the look"
"""Key of the names that every definition starts with; not a valid identifier, so no expression can use it."""


class Interpreter:
    """Compiles entries to functions of the names with which they are drawn."""

    def __init__(self, find: Find) -> None:
        """`find` looks up a shape that a model file defines."""
        self.find = find

    def definition(self, entry: dict[str, Node], parameters: str, shared: Values, scope: Scope) -> Draw:
        """Return an entry as a shape for other entries; `parameters` as in `w, d, paint, inset=0`."""
        takes = scope.parameters(parameters)
        build = self.part(entry, scope.knowing(takes))

        def draw(look: Values, values: Sequence[object], options: Values) -> Mesh:
            given = dict(zip(takes, values, strict=False)) | options
            defaults = {name: default(look) for name, default in takes.items() if default and name not in given}
            if len(values) > len(takes) or given.keys() | defaults.keys() != takes.keys():
                raise scope.fault(f"takes ({', '.join(takes)}); given {len(values)} and ({', '.join(options)})")
            return build({**look, **shared, **defaults, **given, LOOK: look})

        return draw

    def part(self, node: Node, scope: Scope) -> Build:
        """Return the builder of one shape with its options and moves, or of a named mesh."""
        if not isinstance(node, dict):
            return scope.expression(node)
        if not node:
            raise scope.fault("an entry has no shape")
        (key, value), *others = node.items()
        rest = dict(others)
        if key == "let":
            return self._let(value, rest, scope)
        if key == "for":
            bound, values = scope.at(key).loop(value)
            inner = self.part(rest, scope.knowing(bound))
            return lambda names: join(inner({**names, **dict(zip(bound, v, strict=True))}) for v in values(names))
        if key == "when":
            holds, inner = scope.at(key).expression(value), self.part(rest, scope)
            return lambda names: inner(names) if holds(names) else empty()
        moves = {name: rest.pop(name) for name in tuple(rest) if name in MOVES}
        build = self._shape(key, value, rest, scope.at(key))
        for move, amount in moves.items():
            build = MOVES[move](build, amount, scope.at(move))
        return build

    def named(self, node: Node, scope: Scope) -> tuple[list[tuple[str, Build]], Scope]:
        """Return the named builders of a `let`, in order, and the scope after it."""
        if not isinstance(node, dict):
            raise scope.fault("`let` takes names and their values")
        found = []
        for name, value in node.items():
            found.append((name, self.part(value, scope.at(name))))
            scope = scope.knowing((name,))
        return found, scope

    def _let(self, node: Node, rest: dict[str, Node], scope: Scope) -> Build:
        found, inside = self.named(node, scope)
        inner = self.part(rest, inside)

        def bound(names: Values) -> Mesh:
            names = dict(names)
            for name, value in found:
                names[name] = value(names)
            return inner(names)

        return bound

    def _shape(self, key: str, value: Node, options: dict[str, Node], scope: Scope) -> Build:
        if key == "use":
            return scope.expression(value)
        if not isinstance(value, list) and key not in LINES:
            raise scope.fault("takes a list")
        if isinstance(value, list) and key in ("parts", "either"):
            if options:
                raise scope.fault(f"has no options ({', '.join(options)})")
            return (self._parts if key == "parts" else self._either)(value, scope)
        draw = self._drawn(key, scope)
        ordered: list[Node] = value if isinstance(value, list) and key not in LINES else [value]
        if options.get("facing") in FACINGS:
            options["facing"] = repr(options["facing"])
        values = scope.expression([*ordered, *options.values()])
        count, words = len(ordered), tuple(options)

        def build(names: Values) -> Mesh:
            found = values(names)
            try:
                return draw(names, found[:count], dict(zip(words, found[count:], strict=True)))
            except (ArithmeticError, LookupError, TypeError, ValueError) as error:
                raise scope.fault(str(error)) from error

        return build

    def _drawn(self, key: str, scope: Scope) -> Draw:
        shape = SHAPES.get(key)
        if shape:
            return lambda names, values, options: shape(*values, **options)
        defined = self.find(key)
        if not defined:
            raise scope.fault("is not a shape")
        return lambda names, values, options: defined(cast(Values, names[LOOK]), values, options)

    def _parts(self, nodes: list[Node], scope: Scope) -> Build:
        builds = [self.part(node, scope) for node in nodes]
        return lambda names: join(build(names) for build in builds)

    def _either(self, nodes: list[Node], scope: Scope) -> Build:
        choices = []
        for node in nodes:
            rest: dict[str, Node] = dict(node) if isinstance(node, dict) else {"use": node}
            choices.append((scope.expression(rest.pop("when", "True")), self.part(rest, scope)))

        def build(names: Values) -> Mesh:
            return next((inner(names) for holds, inner in choices if holds(names)), empty())

        return build


def _shifted(build: Build, amount: Node, scope: Scope) -> Build:
    by = scope.expression(amount)
    return lambda names: shift(build(names), *by(names))


def _stretched(build: Build, amount: Node, scope: Scope) -> Build:
    by = scope.expression(amount)
    return lambda names: stretch(build(names), *by(names))


def _turned(build: Build, amount: Node, scope: Scope) -> Build:
    """`[y, 90]`, optionally with a point on the axis as third element, or several of these."""
    if not isinstance(amount, list) or not amount:
        raise scope.fault("takes an axis and degrees")
    if isinstance(amount[0], list):
        for each in amount:
            build = _turned(build, each, scope)
        return build
    axis, by = str(amount[0]), scope.expression(amount[1:])
    if axis not in ("x", "y", "z"):
        raise scope.fault(f"`{axis}` is not an axis (x, y, z)")
    return lambda names: turn(build(names), axis, *by(names))


MOVES: dict[str, Callable[[Build, Node, Scope], Build]] = {"stretch": _stretched, "turn": _turned, "shift": _shifted}
