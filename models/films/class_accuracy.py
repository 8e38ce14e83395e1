"""Mean accuracy of classes: how often each action, set of objects and instruction is named right (thesis 4.5.1)."""

from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from typing import Any

from hearth.models.films.clip_data import Instruction

MEASURED: dict[str, Callable[[Instruction], Hashable]] = {
    "action": lambda done: done.action,
    "objects": lambda done: done.objects,
    "steps": lambda done: done,
}
"""The part of an instruction that each column of tables 4.2 and 4.3 compares."""


def accuracies(wanted: Sequence[Instruction], named: Sequence[Instruction]) -> dict[str, float]:
    """Columns of tables 4.2 and 4.3: `action`, `objects`, `steps`, each the mean over its classes, and their `mean`.

    Every class counts the same, however many clips it has: naming the commonest everywhere gets one of them right.
    """
    found = {name: _mean(wanted, named, part) for name, part in MEASURED.items()}
    return {**found, "mean": sum(found.values()) / len(found)}


def _mean(wanted: Sequence[Instruction], named: Sequence[Instruction], part: Callable[[Instruction], Any]) -> float:
    right: defaultdict[Hashable, list[bool]] = defaultdict(list)
    for one, other in zip(wanted, named, strict=True):
        right[part(one)].append(part(one) == part(other))
    return sum(sum(each) / len(each) for each in right.values()) / len(right) if right else 0.0
