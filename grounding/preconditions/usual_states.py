"""States that people take for granted of things in action set 3: clean dishes, full glasses, hot coffee, whole bread.

The rows of `usual_states.yaml` are soft conditions of programs. Perturbations violate them, and repairs restore them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from hearth.grounding.preconditions.conditions import Condition
from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import Key, Literal
from hearth.schemas.program import Program
from hearth.storage.input_files import load_yaml

FILE = Path(__file__).with_name("usual_states.yaml")

_POSITIONS = {"first": 0, "second": 1}


@dataclass(frozen=True, slots=True)
class Restoring:
    """A way to bring a condition about.

    Attributes:
        steps: each an action and its objects: `x` for the thing, `d` and `e` for the things that it is done with.
        classes: of d, and of e, which is close to d; none where no step names it.
        belongs: whether d has to be something that belongs in x.
    """

    steps: tuple[tuple[str, tuple[str, ...]], ...]
    classes: Mapping[str, tuple[str, ...]]
    belongs: bool = False


@dataclass(frozen=True, slots=True)
class UsualState:
    """A row of `usual_states.yaml`.

    Attributes:
        condition: the name of the condition.
        acts: the position of the thing by action.
        properties: those that the thing has, all of them.
        kinds, classes: of the thing; any where there is none.
        seen_to_by: the actions after which nothing is taken for granted.
        violated: the name of the perturbation and the condition instead; none where no perturbation violates it.
        restored: ways to bring it about, best first.
    """

    condition: str
    acts: Mapping[str, int]
    properties: frozenset[str]
    kinds: frozenset[str]
    classes: frozenset[str]
    seen_to_by: frozenset[str]
    violated: tuple[str, str] | None
    restored: tuple[Restoring, ...]

    def is_of(self, name: str, knowledge: Knowledge) -> bool:
        """Return whether things of a class are meant."""
        if not all(knowledge.has(name, each) for each in self.properties):
            return False
        anything = not self.kinds and not self.classes
        return anything or name in self.classes or not self.kinds.isdisjoint(knowledge.ancestors(name))


@lru_cache(maxsize=1)
def usual_states() -> Mapping[str, UsualState]:
    """Return the rows of the file by the condition; each condition has one."""
    return {fields["condition"]: _row(fields) for fields in load_yaml(FILE).values()}


def _row(fields: Mapping[str, Any]) -> UsualState:
    things = fields["things"]
    return UsualState(
        condition=fields["condition"],
        acts={action: _POSITIONS[which] for action, which in fields["acts"].items()},
        properties=frozenset(things.get("properties", ())),
        kinds=frozenset(things.get("kinds", ())),
        classes=frozenset(things.get("classes", ())),
        seen_to_by=frozenset(fields["seen_to_by"]),
        violated=next(iter(fields.get("violated", {}).items()), None),
        restored=tuple(map(_restoring, fields.get("restored", ()))),
    )


def _restoring(way: Mapping[str, Any]) -> Restoring:
    steps = tuple((action, tuple(objects)) for action, *objects in map(str.split, way["steps"]))
    return Restoring(steps, {name: tuple(way[name]) for name in "de" if name in way}, way.get("belongs", False))


def usual_conditions(program: Program, knowledge: Knowledge) -> Iterator[Condition]:
    """Yield the states that a program takes for granted of its things at its steps; none in sets 1 and 2."""
    if knowledge.action_set != LATEST:
        return
    for row in usual_states().values():
        settled: set[Key] = set()
        for number, step in enumerate(program.steps):
            position = row.acts.get(step.action, len(step.objects))
            if position < len(step.objects):
                key = step.objects[position].key
                if key not in settled and row.is_of(key[0], knowledge):
                    settled.add(key)
                    yield Condition(Literal(row.condition, (key,)), number, hard=False)
            if step.action in row.seen_to_by:
                settled.update(ref.key for ref in step.objects)
