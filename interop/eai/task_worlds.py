"""Tasks of the interface as worlds of ours: graphs, names of things, gold programs, goals."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from hearth.interop.eai.wheel import Task, Wheel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_steps
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@dataclass(frozen=True, eq=False)
class TaskWorld:
    """A task at its start.

    Attributes:
        task: the task.
        start: the world.
        names: class names of the things that the gold program changes, each with its node; answers may name no others.
        final: edges of the gold program's end.
        final_states: states of nodes there.
        gold: its steps, bound.
    """

    task: Task
    start: World
    names: Mapping[str, int]
    final: frozenset[tuple[int, str, int]]
    final_states: Mapping[int, frozenset[str]]
    gold: tuple[Step, ...]


def task_world(wheel: Wheel, number: str, knowledge: Knowledge) -> TaskWorld:
    """Return a task of a wheel at its start; kept for the next model."""
    return _task_world(wheel, number, knowledge)


@lru_cache(maxsize=400)
def _task_world(wheel: Wheel, number: str, knowledge: Knowledge) -> TaskWorld:
    before, after = wheel.pair(number)
    home = Home.from_release(before, "TrimmedTestScene1", knowledge)
    states = {node["id"]: frozenset(node["states"]) for node in after["nodes"]}
    gold = tuple(_step(line, knowledge) for line in wheel.gold(number))
    return TaskWorld(wheel.tasks[number], World.start(home), named(before, after), _edges(after), states, gold)


def _edges(graph: Mapping[str, Any]) -> frozenset[tuple[int, str, int]]:
    return frozenset((e["from_id"], e["relation_type"], e["to_id"]) for e in graph["edges"])


def named(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, int]:
    """Return the classes of nodes that differ between two graphs, in states or relations; of several, the last id."""
    facts = [
        {node["id"]: (sorted(node["states"]), sorted(node["properties"])) for node in graph["nodes"]}
        for graph in (before, after)
    ]
    differ = {number for number in facts[0].keys() | facts[1].keys() if facts[0].get(number) != facts[1].get(number)}
    for one, _, other in _edges(before) ^ _edges(after):
        differ |= {one, other}
    classes = {node["id"]: node["class_name"] for graph in (after, before) for node in graph["nodes"]}
    return {classes[number]: number for number in sorted(differ) if number in classes}


def _step(line: str, knowledge: Knowledge) -> Step:
    """Return a gold step, bound: its numbers are `(1.1001)`."""
    (found,) = parse_steps(line)  # type: ignore[misc]
    return bound(found.action, [(ref.name, ref.node or ref.instance) for ref in found.objects], knowledge)


def bound(action: str, things: list[tuple[str, int]], knowledge: Knowledge) -> Step:
    """Return a step of an action with nodes."""
    known = knowledge.action(action)
    name = known.name if known is not None else action
    return Step(name, tuple(ObjectRef(thing, 1, node) for thing, node in things))
