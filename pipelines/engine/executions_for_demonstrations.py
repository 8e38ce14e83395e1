"""The executions that are pictured from above: one of each of some programs, in a home drawn for it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from hearth.schemas.rng import derive, rng


def chosen(ran: Iterable[tuple[str, str, str]], homes: Sequence[str], count: int, seed: int) -> list[str]:
    """Yield the executions to picture, home by home, so that the common parts of a home's pictures are drawn once.

    Args:
        ran: program, execution and home of those that ran.
        homes: all homes, in order; executions in others are left out.
        count: programs at most; of more, those that the seed draws.
        seed: of the programs and their executions.
    """
    runs: dict[str, list[tuple[str, str]]] = {}
    for program, execution, home in ran:
        if home in homes:
            runs.setdefault(program, []).append((home, execution))
    programs = sorted(runs, key=lambda name: (derive(seed, "demonstration", name), name))[:count]
    picked = [rng(seed, "demonstration run", name).choice(sorted(runs[name])) for name in programs]
    return [execution for _, execution in sorted(picked)]
