"""The assignment of tasks: every task under every condition equally often, and every person under every condition.

Trials stand in one row, number i under condition i mod C; the task moves on by one as well, and by one more each time
that both would begin anew, so that all pairs come up. A person has a stretch of the row: stretches hold each condition
equally often, but for one trial, and no task twice. Within a person, each run of C trials is put into the order of a
row of a Latin square, so that conditions come first, second, ... equally often. Names are shuffled by the seed.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import isqrt, lcm
from random import Random

from hearth.schemas.rng import rng
from hearth.studies.study import Study


@dataclass(frozen=True, slots=True)
class Planned:
    """A trial that is to be done.

    Attributes:
        item: number of the task or program.
        condition: its name.
        repeat: which of the trials of this task under this condition.
    """

    item: int
    condition: str
    repeat: int


Slots = tuple[tuple[Planned, ...], ...]
"""The trials of each place in a study, in order; one person after another takes a place, until one finishes."""


def assignment(study: Study, groups: int = 1) -> Slots:
    """Return the trials of every place in a study.

    Args:
        study: whose seed decides.
        groups: tasks i, i + groups, ... are of a kind; kinds come in turn, so that everybody gets all of them.
    """
    chooser = rng(study.seed, "assignment", study.name)
    items = _in_turn(study.items, groups, chooser)
    names = [each.name for each in study.conditions]
    chooser.shuffle(names)
    square = latin_square(len(names))
    chooser.shuffle(square)
    sizes = _sizes(study.trials, study.people, chooser)
    row = list(_row(items, names, study.trials))
    slots, first = [], 0
    for person, size in enumerate(sizes):
        slots.append(tuple(_ordered(row[first : first + size], names, square, person)))
        first += size
    chooser.shuffle(slots)
    return tuple(slots)


def _in_turn(number: int, groups: int, chooser: Random) -> list[int]:
    """Return the numbers of tasks, shuffled within their kinds; kinds come in turn."""
    kinds = [list(range(kind, number, groups)) for kind in range(min(groups, number))]
    for kind in kinds:
        chooser.shuffle(kind)
    return [kind[turn] for turn in range(max(map(len, kinds))) for kind in kinds if turn < len(kind)]


def _sizes(trials: int, people: int, chooser: Random) -> list[int]:
    """Return how many trials each person has: all as many, but for one."""
    least, more = divmod(trials, people)
    sizes = [least + (person < more) for person in range(people)]
    chooser.shuffle(sizes)
    return sizes


def _row(items: Sequence[int], names: Sequence[str], trials: int) -> Iterator[Planned]:
    round_ = lcm(len(items), len(names))
    count: Counter[tuple[int, str]] = Counter()
    for i in range(trials):
        item, name = items[(i + i // round_) % len(items)], names[i % len(names)]
        yield Planned(item, name, count[item, name])
        count[item, name] += 1


def latin_square(size: int) -> list[list[int]]:
    """Return rows of the numbers below a size in which each number stands once in every row and every column.

    Of an even size it is a Williams design: each number also follows each other once.
    """
    first = [number // 2 if number % 2 == 0 else size - 1 - number // 2 for number in range(size)]
    return [[(each + row) % size for each in first] for row in range(size)]


def _ordered(
    stretch: Sequence[Planned], names: Sequence[str], square: Sequence[Sequence[int]], person: int
) -> Iterator[Planned]:
    """Yield a person's trials; each run of as many as there are conditions has the order of a row of the square."""
    size = len(names)
    for turn, first in enumerate(range(0, len(stretch), size)):
        order = {names[number]: place for place, number in enumerate(square[(person + turn) % size])}
        yield from sorted(stretch[first : first + size], key=lambda each: order[each.condition])


def balanced(study: Study, groups: int = 1) -> list[str]:
    """Return the nearest values of `people` and of `repeats`, one changed at a time, with which all is balanced."""
    numbers = sorted(range(1, study.trials + 1), key=lambda number: abs(number - study.people))
    people = next(
        _fitting((replace(study, people=number) for number in numbers[: min(TRIED, LOOKED // study.trials)]), groups),
        None,
    )
    more = (
        replace(study, repeats=study.repeats + number)
        for number in range(1, 1 + min(TRIED, isqrt(LOOKED // study.trials)))
    )
    repeats = next(_fitting(more, groups), None)
    found = (people and f"`people: {people.people}`", repeats and f"`repeats: {repeats.repeats}`")
    return [each for each in found if each]


def _fitting(studies: Iterable[Study], groups: int) -> Iterator[Study]:
    """Give the studies that are balanced."""
    for study in studies:
        if study.people <= study.trials and not imbalances(study, assignment(study, groups)):
            yield study


TRIED = 60
"""Values of a field that are tried for a study that is not balanced."""

LOOKED = 300_000
"""Trials that are looked at for that, about: with more repeats there are more of them."""


def imbalances(study: Study, slots: Slots) -> list[str]:
    """Return the imbalances of an assignment; none if it is balanced."""
    found = []
    pairs = Counter((each.item, each.condition) for slot in slots for each in slot)
    if set(pairs.values()) != {study.repeats} or len(pairs) != study.items * len(study.conditions):
        found.append(f"not every task is done {study.repeats} times under every condition")
    sizes = [len(slot) for slot in slots]
    if max(sizes) - min(sizes) > 1:
        found.append(f"one person has {max(sizes)} trials and another {min(sizes)}")
    for number, slot in enumerate(slots):
        under = Counter({each.name: 0 for each in study.conditions})
        under.update(each.condition for each in slot)
        fewest = min(under, key=lambda name: under[name])
        if under[fewest] < study.least:
            few = f"{under[fewest]} trial{'s' * (under[fewest] != 1)}"
            found.append(f"place {number + 1} has {few} under `{fewest}`, where `at_least` is {study.least}")
        twice = [item for item, count in Counter(each.item for each in slot).items() if count > 1]
        if twice:
            found.append(f"place {number + 1} has task {twice[0] + 1} twice")
    return found
