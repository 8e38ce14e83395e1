"""Sampling environments in which a program runs: e ~ E_Phi(p) (thesis 5.5.2, eq. 5.10)."""

from __future__ import annotations

from dataclasses import dataclass

from hearth.grounding.environments.default_state import Base, prepared
from hearth.grounding.environments.filling import fill
from hearth.grounding.environments.partial import Draft
from hearth.grounding.environments.placing import bind, wishes_of
from hearth.grounding.environments.satisfying import fulfil
from hearth.grounding.environments.soundness import unsound
from hearth.grounding.preconditions.abduction import Moment, conditions_for
from hearth.grounding.preconditions.checking import unmet
from hearth.grounding.preconditions.conditions import Condition, Preconditions
from hearth.grounding.preconditions.infer import infer
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, Node
from hearth.schemas.literals import CHARACTER, HANDS, Key
from hearth.schemas.program import Program
from hearth.schemas.rng import rng
from hearth.simulation.engine import Execution, run
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import Loose
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

TRIES = 12
"""Environments drawn for one program before it is given up."""


@dataclass(frozen=True, slots=True)
class Environment:
    """A home prepared for a program.

    Attributes:
        base: the home in its default state, which the differences are from.
        gone: ids of the nodes of it that were left out, for a smaller environment.
        seed: the run's seed.
        world: the start.
        program: the program, bound to the world's nodes.
        conditions: what was asked for, the conditions found while sampling included.
        nodes, drafted, removed, states: what differs from the base; states are those of the nodes named, all of them.
        loose: the random things among the nodes, and where they are.
    """

    base: Home
    seed: int
    world: World
    program: Program
    conditions: Preconditions
    nodes: tuple[Node, ...]
    drafted: tuple[Edge, ...]
    removed: tuple[Edge, ...]
    states: tuple[tuple[int, tuple[str, ...]], ...]
    loose: tuple[Loose, ...] = ()
    gone: tuple[int, ...] = ()

    @property
    def added(self) -> tuple[Edge, ...]:
        """The edges that the base does not have."""
        ids = self.world.home.ids
        return (*self.drafted, *(edge for one in self.loose for edge in one.edges(ids)))


def of_draft(draft: Draft, seed: int, program: Program, conditions: Preconditions) -> Environment:
    """What a draft has become."""
    return Environment(
        draft.base.whole,
        seed,
        World.start(draft.home()),
        program,
        conditions,
        (*draft.nodes, *[one.node for one in draft.loose]),
        tuple(draft.added),
        tuple(draft.removed),
        tuple(sorted(draft.states.items())),
        tuple(draft.loose),
        draft.base.gone,
    )


@dataclass(frozen=True, slots=True)
class Size:
    """How many nodes an environment should have.

    Attributes:
        least, most: the number is drawn from between.
        some: how many random ones are added at most to a home that is larger.
        thin: whether a larger home goes without some of what it has, instead.
    """

    least: int = 280
    most: int = 300
    some: int = 12
    thin: bool = False

    @classmethod
    def about(cls, nodes: int) -> Size:
        """So many nodes, ten more or less; larger homes are thinned."""
        return cls(nodes - AROUND, nodes + AROUND, 0, thin=True)

    def base(self, home: Home) -> Base:
        """A home made ready for environments of this size, with room for what a program names."""
        base = prepared(home)
        return base.thinned(self.least - ROOM_FOR_MORE) if self.thin else base


AROUND, ROOM_FOR_MORE = 10, 10
USUAL = Size()


def sample(
    program: Program,
    home: Home,
    seed: int,
    record_id: str = "",
    conditions: Preconditions | None = None,
    size: Size = USUAL,
    rules: Rules = DEFAULT,
    must_run: bool = True,
) -> tuple[Environment, Execution] | Failure:
    """Draw an environment in which the conditions hold and the program runs.

    Args:
        program: with instances as counters; node ids are ignored.
        home: any home; it is brought to its default state first.
        seed, record_id: all the randomness there is.
        conditions: what must hold; inferred from the program when None.
        size: nodes wanted.
        rules: for the run.
        must_run: draw again, with what the failed run lacked as a further condition, until the program runs.

    Returns:
        The environment and the program's execution in it, or the failure of the last one drawn.
    """
    base = size.base(home)
    found = infer(program, base.knowledge, rules) if conditions is None else conditions
    if isinstance(found, Failure):
        return found
    failure = unplaceable(program, base)
    if failure is not None:
        return failure
    for attempt in range(TRIES):
        environment = draw(program, base, found, seed, record_id, attempt, size)
        execution = run(environment.world, environment.program, rules)
        missing = unmet(environment.conditions, environment.world, _nodes(environment.program))
        fault = unsound(environment.world)
        if not missing and fault is None and (execution.failure is None or not must_run):
            return environment, execution
        failure = _unmet(missing[0]) if missing else fault or execution.failure
        if attempt % 2 and execution.failure is not None and not missing:
            found = _with_demand(found, environment, execution, base)
    assert failure is not None
    return failure


def unplaceable(program: Program, base: Base) -> Failure | None:
    """Why a home can't hold what a program names, whatever is sampled: it lacks a room, or nobody knows where a thing
    belongs.
    """
    for tick, steps in enumerate(program.ticks()):
        for step in steps:
            for ref in step.objects:
                found = base.homeless(ref.name)
                if found is not None:
                    code, expected, actual = found
                    return Failure(code, tick, step.agent, step.action, (), (ref.name,), expected, actual)
    return None


def _nodes(program: Program) -> dict[Key, int]:
    return {ref.key: ref.node for ref in program.objects() if ref.node is not None}


def _unmet(condition: Condition) -> Failure:
    names = tuple(name for name, _ in condition.objects)
    return Failure(Code.CONDITION_UNMET, names=names, expected=str(condition), actual="not so in what was drawn")


def draw(
    program: Program, base: Base, conditions: Preconditions, seed: int, record_id: str, attempt: int, size: Size
) -> Environment:
    """One environment in which the conditions hold; whether the program runs in it remains to be seen."""
    generator = rng(seed, "sample", base.home.name, record_id, attempt)
    draft = Draft(base, generator)
    bind(draft, wishes_of(program, conditions, base.knowledge))
    fulfil(draft, conditions)
    settle_character(draft, program, conditions)
    fill(draft, size.least, size.most, size.some)
    return of_draft(draft, seed, program.bound(draft.binding), conditions)


def settle_character(draft: Draft, program: Program, conditions: Preconditions) -> None:
    """Where its conditions want the character, else in another room than the program starts in."""
    base = draft.base
    home = base.home
    me = base.character
    rooms = [home.ids[i] for i in indices(home.rooms)]
    near = [c.objects[0] for c in conditions if c.name in ("nearby", "holds") and c.objects[-1] == CHARACTER]
    if me in draft.room:
        room = draft.room[me]
    elif near:
        room = draft.room_of(draft.binding[near[0]])
    else:
        first = next((ref.key for step in program.steps for ref in step.objects), None)
        begin = draft.binding.get(first, -1) if first else -1
        begin = begin if begin in rooms else draft.room_of(begin)
        room = draft.rng.choice([r for r in rooms if r != begin] or rooms)
    draft.removed.extend(Edge(me, "INSIDE", home.ids[i]) for i in indices(base.start.agents[0].inside))
    draft.added.append(Edge(me, "INSIDE", room))
    _bring(draft, me, room)


def _bring(draft: Draft, me: int, room: int) -> None:
    """What the character holds is where it is, unless it is said to be elsewhere."""
    held = [edge.target for edge in draft.added if edge.source == me and edge.relation in HANDS]
    for node_id in held:
        if draft.room_of(node_id) < 0:
            draft.settle(node_id, room)


def _with_demand(
    conditions: Preconditions, environment: Environment, execution: Execution, base: Base
) -> Preconditions:
    """The conditions with what the failed run lacked."""
    failure = execution.failure
    assert failure is not None
    keys = {node: key for key, node in _nodes(environment.program).items()}
    moment = Moment(
        environment.program, failure.tick, failure, execution.final, environment.world, keys, base.knowledge
    )
    known = {c.literal for c in conditions}
    new = next((c for c in conditions_for(moment) if c.literal not in known), None)
    return conditions if new is None else conditions.plus(new)
