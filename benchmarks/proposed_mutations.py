"""The mutations that Cosmic Ray proposes for files of the checkout, and those that are drawn of them."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]

UNNOTICED = ("NoOp", "_Eq_Is", "_Is_Eq", "_NotEq_IsNot", "_IsNot_NotEq")
"""Operators that change nothing: names, small numbers and members of enumerations that are equal are the same."""


class Mutation(NamedTuple):
    """A place, and what Cosmic Ray does there."""

    file: str
    line: int
    column: int
    operator: str
    occurrence: int
    """The number of the place in the file, of those at which the operator applies."""


def _without_behaviour(tree: ast.AST) -> set[tuple[int, int]]:
    """Return the places of types, slots of classes and sizes of caches: no test can notice a mutation there."""
    found: set[tuple[int, int]] = set()
    for node in ast.walk(tree):
        fields = [getattr(node, name, None) for name in ("annotation", "returns")]
        for decorator in getattr(node, "decorator_list", ()):
            if isinstance(decorator, ast.Call):
                cached = ast.unparse(decorator.func).endswith("cache")
                fields += [word.value for word in decorator.keywords if cached or word.arg == "slots"]
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            fields += node.body
        for field in filter(None, fields):
            for part in ast.walk(field):
                if hasattr(part, "lineno"):
                    found |= {(line, -1) for line in range(part.lineno + 1, part.end_lineno)}
                    found |= {(part.lineno, column) for column in range(part.col_offset, 400)
                              if part.lineno < part.end_lineno or column < part.end_col_offset}  # fmt: skip
    return found


def proposed(file: str, root: Path = ROOT) -> Iterator[Mutation]:
    """All mutations of a file."""
    from cosmic_ray.ast import ast_nodes, get_ast
    from cosmic_ray.plugins import get_operator, operator_names

    source = (root / file).read_bytes()
    typed = _without_behaviour(ast.parse(source))
    tree = get_ast(source.decode())
    if len(names := sorted(operator_names())) < 50:
        raise SystemExit("Cosmic Ray lacks its own operators; install it with what it needs: pip install cosmic-ray")
    for name in names:
        kind = get_operator(name)
        if kind.arguments() or name.endswith(UNNOTICED):
            continue
        operator, number = kind(), 0
        for node in ast_nodes(tree):
            for (line, column), _ in operator.mutation_positions(node):
                if (line, column) not in typed and (line, -1) not in typed:
                    yield Mutation(file, line, column, name, number)
                number += 1


def drawn(rooms: Sequence[str], number: int, seed: int, root: Path = ROOT) -> list[Mutation]:
    """Equally many of each room: a place first, then one of its mutations, so that no operator outweighs the others."""
    found = []
    for n, room in enumerate(rooms):
        share = number * (n + 1) // len(rooms) - number * n // len(rooms)
        places: dict[tuple[str, int, int], list[Mutation]] = defaultdict(list)
        for path in sorted((root / room).rglob("*.py")):
            for mutation in proposed(path.relative_to(root).as_posix(), root):
                places[mutation[:3]].append(mutation)
        rng = Random(f"{seed}/{room}")
        for place in rng.sample(sorted(places), min(share, len(places))):
            found += next(([m] for m in rng.sample(places[place], len(places[place])) if _is_made(m, root)), [])
    return found


def _is_made(mutation: Mutation, root: Path) -> bool:
    """Cosmic Ray fails at some that it proposes, such as another exception for `except module.Error`."""
    try:
        return bool(mutated((root / mutation.file).read_text("utf-8"), mutation))
    except (AttributeError, ValueError):
        return False


def mutated(source: str, mutation: Mutation) -> str:
    """The text of a file with the mutation made."""
    from cosmic_ray.mutating import mutate_code
    from cosmic_ray.plugins import get_operator

    made = mutate_code(source, get_operator(mutation.operator)(), mutation.occurrence)
    if made is None:
        raise ValueError(f"{mutation} cannot be made")
    return made
