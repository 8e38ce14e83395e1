"""The grammar of the instructions that are legal now, for constrained decoding: `Grab milk 142`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from hearth.kb.tools.line_grammars import Group, LineGrammar, Part, line_grammar, possible
from hearth.simulation.world.bits import indices

if TYPE_CHECKING:
    from hearth.simulation.world.home import Home

WAIT = "wait"
"""The instruction that does nothing."""


def legal_grammar(
    home: Home, masks: Mapping[str, tuple[int, ...]], names: Mapping[str, str] | None = None, *, wait: bool = False
) -> LineGrammar:
    """Return the grammar of instructions, one a line.

    Args:
        home: whose nodes the masks are about.
        masks: of `Legal`.
        names: the actions that may be written, and the word for each; all, by their own names, where None.
        wait: whether `wait` may be written, too.
    """
    chosen = {name: name for name in sorted(masks)} if names is None else {n: w for n, w in names.items() if n in masks}
    alternatives = [parts for action, word in chosen.items() for parts in _written(home, word, masks[action])]
    return line_grammar([*alternatives, *([[WAIT]] if wait else [])])


def _written(home: Home, word: str, masks: tuple[int, ...]) -> Iterator[list[Part]]:
    """Yield the ways to write an action; no thing is named twice in one."""
    if not masks:
        yield [word]
    elif len(masks) == 1:
        yield [f"{word} ", _things(home, masks[0])]
    else:
        first, second = masks
        pairs: list[list[Part]] = [[_things(home, first & ~second), ", ", _things(home, second)]]
        pairs += [[f"{_thing(home, i)}, ", _things(home, second & ~(1 << i))] for i in indices(first & second)]
        yield [f"{word} ", Group(possible(pairs))]


def _things(home: Home, mask: int) -> tuple[str, ...]:
    return tuple(_thing(home, i) for i in indices(mask))


def _thing(home: Home, i: int) -> str:
    return f"{home.classes[i]} {home.ids[i]}"
