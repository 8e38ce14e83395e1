"""Circumstances: what the original's steps are done in, and a repaired program has to do them in, too.

An activity is more than its end: a person that types standing and sits down afterwards has not done the same as one
that sits down to type.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple

from hearth.grounding.preconditions.conditions import Condition
from hearth.grounding.preconditions.postconditions import Postconditions, facts, missing, nodes_of
from hearth.grounding.preconditions.usual_states import usual_states
from hearth.schemas.literals import HOLDS, Key, Literal
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.engine import Execution
from hearth.simulation.literal_truth import holds

RESTING = ("SITTING", "LYING")

_STATES = (*RESTING, "OPEN", "ON", "PLUGGED_IN", "CLEAN")
"""States that are brought about for later steps; their opposites only end them."""


class Lost(NamedTuple):
    """Return the first step that a repaired program does in other circumstances.

    Its number, its tick, and the missing circumstance.
    """

    step: int
    tick: int
    facts: Postconditions


def circumstances(execution: Execution, conditions: Iterable[Condition] = ()) -> tuple[Postconditions, ...]:
    """For each step of a program that runs, what holds before it and repairs have to keep.

    Circumstances are the posture of the step's character and its seat in the program; that it does not hold an object
    of the step; and the results of the earlier steps: objects held, open, on, plugged in and clean, and objects ON or
    INSIDE others. Facts of the environment, rooms, and the targets of pouring do not count. Of the program's conditions
    those count that people take for granted of a thing in action set 3: the plate eaten from is clean.
    """
    program, worlds = execution.program, execution.worlds
    nodes = nodes_of(program, worlds[0])
    home = worlds[0].home
    rooms = {key for key, node in nodes.items() if home.rooms >> home.index[node] & 1}
    poured = {tuple(ref.key for ref in step.objects) for step in program.steps if step.action == "Pour"}
    now = [
        frozenset(f for f in facts(world, nodes, _STATES) if f.target not in rooms and f.terms not in poured)
        for world in worlds
    ]
    made: list[frozenset[Literal[Key]]] = [frozenset()]
    for before, after in pairwise(now):
        made.append(made[-1] & after | after - before)
    found = []
    usual = [each for each in conditions if each.name in usual_states() and not each.hard]
    for number, (step, tick) in enumerate(zip(program.steps, _ticks(program), strict=True)):
        character = (CHARACTER_CLASS, step.agent + 1)
        others = (f for f in made[tick] if f.subject[0] != CHARACTER_CLASS or f.name == HOLDS)
        held = (Literal(HOLDS, (character, ref.key)) for ref in step.objects)
        free = (f._replace(negated=True) for f in held if f not in now[tick])
        taken = (each.literal for each in usual if each.step == number and holds(each.literal, worlds[tick], nodes))
        found.append((*_posture(character, now[tick]), *sorted(others), *free, *taken))
    return tuple(found)


def _posture(character: Key, now: frozenset[Literal[Key]]) -> Iterator[Literal[Key]]:
    """Standing, or sitting or lying and on which of the program's objects."""
    resting = [Literal(state, (character,)) for state in RESTING]
    for posture in resting:
        yield posture._replace(negated=posture not in now)
    if not now.isdisjoint(resting):
        yield from sorted(f for f in now if f.name == "ON" and f.subject == character)


def lost(
    original: Program, wanted: Sequence[Postconditions], sources: Sequence[int], execution: Execution
) -> Lost | None:
    """Return the first of the original's steps that a repaired program does in other circumstances.

    Args:
        original: the program before any repair, bound.
        wanted: the circumstances of each of its steps.
        sources: for each step of the repaired program, the number of the original's step it is, or below 0.
        execution: of the repaired program.
    """
    worlds = execution.worlds
    nodes = nodes_of(original, worlds[0])
    for number, (source, tick) in enumerate(zip(sources, _ticks(execution.program), strict=True)):
        if source >= 0 and (facts := missing(wanted[source], nodes, worlds[tick])):
            return Lost(number, tick, facts)
    return None


def _ticks(program: Program) -> list[int]:
    """Return the tick of each step."""
    return [tick for tick, together in enumerate(program.ticks()) for _ in together]
