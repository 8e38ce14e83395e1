"""Binding a program whose instances are counters to the nodes of a home, so that all its steps can run (thesis 2.4.1).

Depth-first over the ticks: a tick that names a new object runs with each of the home's candidates, best first. A failed
try is undone by going back to the world before, at no cost because worlds are values.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import reduce
from itertools import product
from operator import and_, or_

from hearth.grounding.node_ids import by_number, classes_of
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Key
from hearth.schemas.program import Program, Step
from hearth.schemas.short_repr import brief
from hearth.simulation.engine import act, ready, together, unfit
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

MAX_ACTS = 20_000
"""Steps tried before a binding is given up."""


@dataclass(frozen=True, slots=True)
class Binding:
    """A program's objects as nodes, and how many steps were tried to find them."""

    nodes: dict[Key, int]
    tried: int

    __repr__ = brief

    def apply(self, program: Program) -> Program:
        """Return the program bound; what has a node keeps it."""
        return replace(program, steps=tuple(_bound(step, self.nodes, partly=True) for step in program.steps))


def bind(program: Program, world: World, rules: Rules = DEFAULT) -> Binding | Failure:
    """Find nodes with which every step runs (thesis 2.4.1).

    Objects that are bound already keep their node, and one whose number names a node gets it (see `node_ids`).
    Distinct instances get distinct nodes; only a room that serves as another (`kitchen`, where it is part of the dining
    room) stands for both.

    Returns:
        The binding, or the failure that pruned the last candidate of the furthest step reached.

    Examples:
        >>> hearth.bind(program, world).nodes
        {('fridge', 1): 137, ('milk', 1): 142}
    """
    found, failure = bind_far(program, world, rules)
    return failure or found


def bind_far(program: Program, world: World, rules: Rules = DEFAULT) -> tuple[Binding, Failure | None]:
    """Return the binding of `bind`, or that of the furthest step reached and why it goes no further."""
    program = Binding(_by_number(program, world), 0).apply(program)
    search = _Search(program, rules)
    fixed = {ref.key: ref.node for ref in program.objects() if ref.node is not None}
    if not program.steps:
        return Binding({}, 0), None
    stack = [search.options(0, ready(world, program), fixed)]
    while stack and search.tried < MAX_ACTS:
        option = next(stack[-1], None)
        if option is None:
            stack.pop()
        elif len(stack) == len(search.ticks):
            return Binding(option[0], search.tried), None
        else:
            stack.append(search.options(len(stack), option[1], option[0]))
    return Binding(search.nodes, search.tried), search.furthest


def bind_stored(program: Program, world: World, rules: Rules = DEFAULT) -> Binding | Failure:
    """`bind`; but where every instance is the id of a node of its class, as simulators print them, these are meant
    whether or not all steps can then run.
    """
    named = Binding(_by_number(program, world), 0).apply(program)
    if any(ref.node is None for ref in named.objects()):
        return bind(program, world, rules)
    return Binding({ref.key: ref.node for ref in named.objects() if ref.node is not None}, 0)


def _by_number(program: Program, world: World) -> dict[Key, int]:
    free = [ref for ref in program.objects() if ref.node is None]
    return by_number(free, classes_of(world.home), world.home.knowledge) if free else {}


def nearest(program: Program, world: World) -> Binding:
    """Give each object the nearest of its candidates at the start, whether or not the steps then run.

    Objects that are bound already keep their node; one without a candidate gets none.
    """
    search = _Search(program, DEFAULT)
    nodes = {ref.key: ref.node for ref in program.objects() if ref.node is not None}
    for step in program.steps:
        for ref in step.objects:
            if ref.key not in nodes and (found := search._ordered(ref.key, world, step.agent, nodes)):
                nodes[ref.key] = found[0]
    return Binding(nodes, 0)


class _Search:
    """The candidates of each object, and the furthest failure so far."""

    def __init__(self, program: Program, rules: Rules) -> None:
        self.ticks = tuple(program.ticks())
        self.rules = rules
        self.tried = 0
        self.furthest = Failure(Code.UNBOUND, expected="a step", actual="none")
        self.nodes: dict[Key, int] = {}
        self.reached = -1
        self.uses: dict[Key, set[tuple[str, int]]] = {}
        # Several nodes of a class may be named by their ids alone: `fixed` of `bind` has but one of them.
        self.own = {(ref.name, ref.node) for ref in program.objects() if ref.node is not None}
        for step in program.steps:
            for position, ref in enumerate(step.objects):
                self.uses.setdefault(ref.key, set()).add((step.action, position))
        self.candidates: dict[Key, int] = {}

    def options(self, number: int, world: World, nodes: dict[Key, int]) -> Iterator[tuple[dict[Key, int], World]]:
        """Every way to do tick `number` from a world: the binding with its new objects, and the world after."""
        steps = self.ticks[number]
        if (failure := next(filter(None, (unfit(world, step) for step in steps)), None)) is not None:
            self._fail(number, failure, nodes)
            return
        new: dict[Key, Step] = {}
        for step in steps:
            for ref in step.objects:
                if ref.key not in nodes:
                    new.setdefault(ref.key, step)
        choices = [self._ordered(key, world, step.agent, nodes) for key, step in new.items()]
        for (key, step), found in zip(new.items(), choices, strict=True):
            if not found:
                self._fail(number, self._nothing(step, key, world), nodes)
        for chosen in product(*choices):
            if len({(node, _room(key, world)) for key, node in zip(new, chosen, strict=True)}) < len(chosen):
                continue
            bound = {**nodes, **dict(zip(new, chosen, strict=True))}
            self.tried += 1
            after = self._done(world, steps, bound)
            if isinstance(after, Failure):
                self._fail(number, after, bound)
            else:
                yield bound, after

    def _done(self, world: World, steps: tuple[Step, ...], bound: dict[Key, int]) -> World | Failure:
        if len(steps) == 1:
            return act(world, _bound(steps[0], bound), self.rules)
        return together(world, [_bound(step, bound) for step in steps], self.rules)

    def _fail(self, number: int, failure: Failure, nodes: dict[Key, int]) -> None:
        """Keep the last failure of the furthest step; of equal failures the first, whose nodes are the best."""
        found = replace(failure, tick=number)
        if number > self.reached or (number == self.reached and found != self.furthest):
            self.reached, self.nodes, self.furthest = number, nodes, found

    def _ordered(self, key: Key, world: World, agent_number: int, nodes: dict[Key, int]) -> list[int]:
        """Ids of the candidates that are not taken: those at hand first, then those in the room, then by id."""
        home = world.home
        mask = self.candidates.get(key)
        if mask is None:
            mask = self.candidates[key] = self._candidates(key, world)
        room_name = _room(key, world)
        every = {*self.own, *((other[0], node) for other, node in nodes.items())}
        others = (node for name, node in every if not room_name or name == room_name)
        taken = {home.index[node] for node in others if node in home.index}
        if not world.agents:
            return [home.ids[i] for i in indices(mask) if i not in taken]
        agent = world.agents[min(agent_number, len(world.agents) - 1)]
        room = edge_rows.agent_room(world, agent)
        rank = {
            i: (not edge_rows.is_close(world, agent, i), edge_rows.room_of(world, i) != room, i)
            for i in indices(mask)
            if i not in taken and i != agent.index
        }
        return [home.ids[i] for i in sorted(rank, key=rank.__getitem__)]

    def _candidates(self, key: Key, world: World) -> int:
        home = world.home
        able = reduce(and_, (_able(world, action, position) for action, position in self.uses[key]))
        names = home.knowledge.found_as(key[0])
        return next((mask for mask in (home.by_class.get(name, 0) & able for name in names) if mask), 0)

    def _nothing(self, step: Step, key: Key, world: World) -> Failure:
        names = world.home.knowledge.same_class(key[0])
        present = reduce(or_, (world.home.by_class.get(name, 0) for name in world.home.knowledge.found_as(key[0])), 0)
        return Failure(
            Code.UNBOUND,
            action=step.action,
            agent=step.agent,
            names=(key[0],),
            expected=f"a {' or '.join(names[:3])} in the home",
            actual=self._why_none(key, world, present) if present else "it has none",
        )

    def _why_none(self, key: Key, world: World, present: int) -> str:
        """Return why none of the nodes of a class serves as an object of the program."""
        uses = sorted(self.uses[key])
        unfit = [action for action, position in uses if not present & _able(world, action, position)]
        if unfit:
            return f"{_actions(unfit)} {_works(present)}"
        if not self.candidates[key]:
            return f"{_actions([action for action, _ in uses])} together {_works(present)}"
        count = self.candidates[key].bit_count()
        return f"other objects of the program take {'the only one' if count == 1 else f'all {count}'}"


def _works(present: int) -> str:
    count = present.bit_count()
    return "does not work with the only one" if count == 1 else f"works with none of the {count}"


def _actions(names: list[str]) -> str:
    return ", ".join(f"[{name}]" for name in dict.fromkeys(names))


def _able(world: World, action: str, position: int) -> int:
    known = world.home.knowledge.actions.get(action)
    if known is None or not known.executed or position >= known.arity:
        return world.home.everything
    return world.home.able(action, position)


def _room(key: Key, world: World) -> str:
    """Return the name of a room, "" of a thing: a room that serves as another may stand for both of their names."""
    return key[0] if world.home.knowledge.is_room(key[0]) else ""


def _bound(step: Step, nodes: dict[Key, int], partly: bool = False) -> Step:
    """Return a step with nodes for its unbound objects; objects that may stay unbound (`partly`) do."""
    objects = tuple(
        ref if ref.node is not None or (partly and ref.key not in nodes) else replace(ref, node=nodes[ref.key])
        for ref in step.objects
    )
    return Step(step.action, objects, step.agent, step.joins, step.modifiers)
