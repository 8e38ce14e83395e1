"""`pddl`: a planning domain from the knowledge of actions, and a problem for every execution.

A problem has the execution's initial state; its goal is the execution's changes: states, and the added and removed ON,
INSIDE and HOLDS edges of the things that it moved. CLOSE and FACING, which describe only the character's position, are
not goals. Of action set 3 states that no act brings about are not goals, either: they come by themselves, in time.

A problem leaves out the things that cannot matter to it. It keeps the character and the things that it holds, and the
things that the goal names. It keeps the things that these are INSIDE, up to their rooms, and things ON a seat or bed
among them. It keeps every door that is closed or is to be. A plan of the pruned problem is a plan of the whole home,
too. A thing that was left out could only take up a hand, hide something, stop a walk or occupy a seat, and every thing
with such an effect is kept.
"""

from collections.abc import Iterator, Set
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

from hearth.datasets.dataset import Dataset
from hearth.datasets.export.pddl_domain import planning_domain, relation_predicate
from hearth.datasets.export.program_batches import Wanted, runs, write
from hearth.datasets.format.row_conversion import change_of
from hearth.datasets.verify import StoredHomes
from hearth.kb.action_sets import LATEST
from hearth.kb.knowledge import Knowledge
from hearth.kb.tools.pddl import LIMITS, limit_predicate, option_predicate, options, predicate, unary_predicates
from hearth.schemas.graph import Edge
from hearth.schemas.graph_change import Change, compose
from hearth.schemas.vocabulary import EVERY_STATE, STATE_ID
from hearth.simulation.engine import Execution
from hearth.simulation.rules import DEFAULT, RULES, Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.action_set_3_states import rows_with_further
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.storage.names import file_name, inside

WANTED = frozenset({"ON", "INSIDE", "HOLDS_RH", "HOLDS_LH"})
"""Relations of goals."""

States = tuple[tuple[int, str, bool], ...]
Edges = tuple[tuple[Edge, bool], ...]


@dataclass(frozen=True, slots=True)
class Task:
    """A planning task.

    Attributes:
        name: of the execution.
        world: the start.
        objects: node ids in the problem.
        states: (node, state, whether it shall hold).
        edges: (edge, whether it shall hold).
        program_id: of the executed program.
        rules: of the execution.
    """

    name: str
    world: World
    objects: tuple[int, ...]
    states: States
    edges: Edges
    program_id: str = ""
    rules: Rules = DEFAULT

    def reached(self, final: World) -> bool:
        """Return whether a world satisfies the goal."""
        now = {edge for edge in final.edges() if edge.relation in WANTED}
        return all(final.has_state(node, state) is holds for node, state, holds in self.states) and all(
            (edge in now) is holds for edge, holds in self.edges
        )


def pddl(dataset: Dataset, to: Path, wanted: Wanted) -> int:
    """`domain.pddl` and `problems/EXECUTION.pddl`; executions without lasting changes have no goal and no problem.

    Returns:
        Number of problems.
    """
    write(to / "domain.pddl", planning_domain(dataset.knowledge).encode())
    number = 0
    for task in tasks(dataset, wanted):
        write(inside(to / "problems", f"{file_name(task.name)}.pddl"), problem(task).encode())
        number += 1
    return number


def tasks(dataset: Dataset, wanted: Wanted) -> Iterator[Task]:
    """Yield the planning task of each execution that has a goal, sorted by the ids of program and execution."""
    from hearth.datasets.format.case_rows import start_of

    homes = StoredHomes(dataset)
    for _, run in runs(dataset, wanted):
        row = run.row
        states, edges = _goal(compose(map(change_of, row["ticks"])), dataset.knowledge)
        if states or edges:
            world = start_of(row["environment"], run.home, homes)
            yield _task(row["execution_id"], world, states, edges, row["program_id"], RULES[row["rules"]])


def task_of(execution: Execution, name: str = "", in_time: bool = False) -> Task | None:
    """Return the planning task of an execution; None if it has no goal.

    Args:
        execution: whose changes are the goal.
        name: of the task.
        in_time: whether states that come by themselves are goals, too: food that is cooked. The problem then has all
            things of the program, devices among them.
    """
    start, program = execution.worlds[0], execution.program
    states, edges = _goal(execution.final.changes(start), start.home.knowledge, in_time)
    used = {ref.node for ref in program.objects() if ref.node is not None} if in_time else set()
    return _task(name, start, states, edges, "", execution.rules, used) if states or edges else None


def _task(
    name: str,
    world: World,
    states: States,
    edges: Edges,
    program_id: str,
    rules: Rules,
    used: Set[int] = frozenset(),
) -> Task:
    named = {*used} | {node for node, _, _ in states} | {end for edge, _ in edges for end in (edge.source, edge.target)}
    return Task(name, world, tuple(_objects(world, named)), states, edges, program_id, rules)


def _goal(whole: Change, knowledge: Knowledge, in_time: bool = False) -> tuple[States, Edges]:
    """Return the goal of a net change."""
    coming = {
        effect.literal.terms[-1].name
        for process in (knowledge.processes.values() if in_time else ())
        for effect in process.effects
        if not effect.literal.negated
    }
    states = [(*state, True) for state in whole.set_states] + [(*state, False) for state in whole.cleared_states]
    states = [
        each
        for each in states
        if each[1] in STATE_ID or (each[2] and (knowledge.achieving(each[1]) or each[1] in coming))
    ]
    edges = [(edge, True) for edge in whole.added] + [(edge, False) for edge in whole.removed]
    return tuple(sorted(states)), tuple(sorted((edge, holds) for edge, holds in edges if edge.relation in WANTED))


def _objects(world: World, nodes: set[int]) -> list[int]:
    home = world.home
    kept = 0
    named = mask_of(home.index[node] for node in nodes)
    doors = _closable(world, named)
    waiting = home.characters | named | doors
    for door in indices(doors):
        waiting |= home.between[door]
    for agent in world.agents:
        waiting |= agent.right | agent.left
    seats = home.properties["SITTABLE"] | home.properties["LIEABLE"]
    while waiting:
        kept |= waiting
        found = 0
        for i in indices(waiting):
            found |= edge_rows.containers(world, i)
            room = edge_rows.room_of(world, i)
            found |= 1 << room if room >= 0 else 0
            found |= edge_rows.bearing(world, i) if seats >> i & 1 else 0
        waiting = found & ~kept
    return sorted(home.ids[i] for i in indices(kept))


def _closable(world: World, named: int) -> int:
    """Return the doors that are closed at the start or named by the goal."""
    home = world.home
    return home.doors & (named | world.states[STATE_ID["CLOSED"]])


def problem(task: Task) -> str:
    """Return the problem as text."""
    world, names = task.world, object_names(task)
    agents = {world.home.ids[i] for i in world.home.agents}
    objects = (f"    {name} - {'agent' if node in agents else 'object'}" for node, name in names.items())
    goals = [_literal(f"({predicate('state', state)} {names[node]})", holds) for node, state, holds in task.states]
    goals += [_literal(_edge(edge, names), holds) for edge, holds in task.edges]
    lines = [
        f"; {task.name.splitlines()[0]}",
        "(define (problem execution)",
        "  (:domain hearth)",
        "  (:objects",
        *objects,
        "  )",
        "  (:init",
        *(f"    {fact}" for fact in _facts(task, names)),
        "  )",
        "  (:goal (and",
        *(f"    {goal}" for goal in goals),
        "  ))",
        ")",
    ]
    return "\n".join(lines) + "\n"


def object_names(task: Task) -> dict[int, str]:
    """Return the PDDL name of each node: `coffee_table_41`."""
    home = task.world.home
    return {node: f"{_word(home.classes[home.index[node]])}_{node}" for node in task.objects}


def _word(text: str) -> str:
    word = "".join(char if char.isascii() and char.isalnum() else "_" for char in text.lower())
    return word if word[:1].isalpha() else f"o{word}"


def _literal(fact: str, holds: bool) -> str:
    return fact if holds else f"(not {fact})"


def _edge(edge: Edge, names: dict[int, str]) -> str:
    return f"({relation_predicate(edge.relation)} {names[edge.source]} {names[edge.target]})"


def _facts(task: Task, names: dict[int, str]) -> Iterator[str]:
    world = task.world
    home = world.home
    mask = mask_of(home.index[node] for node in task.objects)
    known = set(unary_predicates(home.knowledge))
    yield from (f"({option_predicate(name)})" for name in options(home.knowledge) if getattr(task.rules, name))
    for node, name in names.items():
        yield from (f"({kind} {name})" for kind in _kinds(world, home.index[node], known))
    for edge in sorted(world.edges(mask)):
        yield _edge(edge, names)
    yield from _blocked(task, names)
    for node, name in names.items():
        i = home.index[node]
        room = edge_rows.room_of(world, i)
        if room >= 0 and room != i and not edge_rows.containers(world, i) >> room & 1:
            yield f"(inside {name} {names[home.ids[room]]})"


def _blocked(task: Task, names: dict[int, str]) -> Iterator[str]:
    """Yield the rooms that each door, when closed, separates, alone or together with other doors.

    The second result has for each door the rooms from which each adjacent room is reachable without passing it.
    """
    home = task.world.home
    there = mask_of(home.index[node] for node in task.objects)
    doors = list(indices(home.doors & there))
    rooms = list(indices(home.rooms & there))
    found: set[tuple[int, int, int]] = set()
    for number in range(1, min(len(doors), _TOGETHER) + 1):
        for closed in combinations(doors, number):
            for room in rooms:
                parted = _reached(home, room, 0) & ~_reached(home, room, mask_of(closed))
                found.update((door, room, other) for door in closed for other in rooms if parted >> other & 1
                             and _reached(home, room, mask_of(closed) & ~(1 << door)) >> other & 1)  # fmt: skip
    for door, room, other in sorted(found):
        yield f"(blocks {names[home.ids[door]]} {names[home.ids[room]]} {names[home.ids[other]]})"
    for door in doors:
        for room in rooms:
            for other in indices(home.between[door] & there & _reached(home, room, 1 << door)):
                yield f"(this-side {names[home.ids[door]]} {names[home.ids[room]]} {names[home.ids[other]]})"


_TOGETHER = 3
"""Greatest number of doors that are considered together."""


def _reached(home: Home, room: int, closed: int) -> int:
    """Return the rooms reachable from a room with some doors closed."""
    reached, open_doors = 1 << room, home.doors & ~closed
    while True:
        more = reached
        for door in indices(open_doors):
            if home.between[door] & reached:
                more |= home.between[door]
        if more == reached:
            return reached
        reached = more


def _kinds(world: World, i: int, known: set[str]) -> Iterator[str]:
    """Yield the facts about a thing's kind and states."""
    home = world.home
    bit, name = 1 << i, home.classes[i]
    if home.rooms & bit:
        yield "is-room"
    yield from (predicate("property", prop) for prop, mask in sorted(home.properties.items()) if mask & bit)
    if predicate("class", name) in known:
        yield predicate("class", name)
    parts = sorted(kind.removeprefix("named-") for kind in known if kind.startswith("named-"))
    yield from (predicate("class_contains", part) for part in parts if part in name)
    yield from (limit_predicate(kind, home.limit(i, lying=kind == "bed_limit")) for kind in LIMITS)
    states = rows_with_further(world) if home.knowledge.action_set == LATEST else world.states
    yield from (predicate("state", state) for state, row in zip(EVERY_STATE, states, strict=False) if row & bit)
