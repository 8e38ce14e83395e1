"""The executions that are filmed for clips, and their homes: a step list is in one part, and so is a test's home.

The thesis films training in homes 1-4, validation in home 5 and tests in all (4.4). Homes count in their order; without
seven of them the last two are still never seen in training.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Mapping, Sequence

from hearth.schemas.rng import rng

TRAIN, VALIDATION, TEST = "train", "validation", "test"

SEEN, BETWEEN, UNSEEN = "seen", "validation", "unseen"
"""Kinds of homes: of training, of validation, and of tests alone."""

SHARES = {TRAIN: 0.7, VALIDATION: 0.1, TEST: 0.2}
"""Shares of the programs in each part."""

COLOURED = 0.25
"""The share of films that have colours and depth, too."""


def home_kinds(homes: Sequence[str]) -> dict[str, str]:
    """Return whether a home is seen in training, by home; of three homes or more the last two are not."""
    unseen = homes[-2:] if len(homes) > 2 else homes[1:]
    rest = homes[: len(homes) - len(unseen)]
    between = rest[-1:] if len(rest) > 1 else ()
    return {name: UNSEEN if name in unseen else BETWEEN if name in between else SEEN for name in homes}


def part_of(program: str, seed: int) -> str:
    """Return the part of a program, and of all with the same steps, drawn from the id that is the first of theirs.

    Nearly all programs are the only one with their steps: they stay in the parts by which models were trained.
    """
    drawn = rng(seed, "clip part", program).random()
    if drawn < SHARES[TRAIN]:
        return TRAIN
    return VALIDATION if drawn < SHARES[TRAIN] + SHARES[VALIDATION] else TEST


ALLOWED: Mapping[str, tuple[str, ...]] = {
    TRAIN: (SEEN,),
    VALIDATION: (BETWEEN, SEEN),
    TEST: (SEEN, UNSEEN, BETWEEN),
}
"""The kinds of homes of each part; of validation's the first that there is."""


def chosen(
    ran: Iterable[tuple[str, str, str]], steps: Mapping[str, Hashable], homes: Sequence[str], count: int, seed: int
) -> dict[str, tuple[str, str]]:
    """Return the executions to film, with the part and the kind of home of each.

    Args:
        ran: program, execution and home of those that ran.
        steps: of each program; those with the same are in one part, whatever their ids.
        homes: all homes, in order.
        count: programs, at most.
        seed: of the parts and of the home of each test.
    """
    kinds = home_kinds(homes)
    by_program: dict[str, list[tuple[str, str]]] = {}
    for program, execution, home in ran:
        if home in kinds:
            by_program.setdefault(program, []).append((execution, kinds[home]))
    first: dict[Hashable, str] = {}
    for program in by_program:
        first[steps[program]] = min(program, first.get(steps[program], program))
    found: dict[str, tuple[str, str]] = {}
    for program, runs in by_program.items():
        part = part_of(first[steps[program]], seed)
        order = _order(part, program, seed)
        pick = next(((kind, name) for kind in order for name in _shuffled(runs, kind, program, seed)), None)
        if pick is not None and len(found) < count:
            found[pick[1]] = (part, pick[0])
    return found


def _order(part: str, program: str, seed: int) -> Sequence[str]:
    """Return the kinds of homes to look in, the first first; a test's in an order of its own."""
    kinds = ALLOWED[part]
    if part != TEST:
        return kinds
    weights = {SEEN: 2.0, UNSEEN: 2.0, BETWEEN: 1.0}
    draw = rng(seed, "clip home", program)
    return sorted(kinds, key=lambda kind: draw.random() ** (1 / weights[kind]), reverse=True)


def _shuffled(runs: Sequence[tuple[str, str]], kind: str, program: str, seed: int) -> list[str]:
    of_kind = sorted(name for name, each in runs if each == kind)
    return rng(seed, "clip run", program).sample(of_kind, len(of_kind))


def coloured(execution: str, seed: int) -> bool:
    """Return whether a film also has colours and depth."""
    return rng(seed, "clip colours", execution).random() < COLOURED
