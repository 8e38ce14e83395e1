"""Running programs: ticks of instructions, each giving a new world or a failure."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from operator import attrgetter

from hearth.schemas.failure_words import USED_UP
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph_change import Change
from hearth.schemas.program import Program, Step
from hearth.schemas.short_repr import brief
from hearth.schemas.vocabulary import STATES
from hearth.simulation.actions.consequences import actions_of
from hearth.simulation.actions.literal_effects import is_gone
from hearth.simulation.actions.metric_checks import followed, stepped_aside
from hearth.simulation.actions.modifier_effects import PLACED, modified
from hearth.simulation.actions.registry import ACTIONS, EVERY, MOVES
from hearth.simulation.motion.giving_way import seated_apart
from hearth.simulation.motion.positions import placed
from hearth.simulation.motion.stride_ahead import is_beside, kept_apart
from hearth.simulation.processes import advanced, widened
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Execution:
    """The result of running a program.

    Attributes:
        program: what was run, bound to node ids.
        worlds: the start, then the world after each tick that was done. They share all that is equal.
        failure: why it stopped before its end, if it did; nothing of the failed tick is done.
        rules: how actions were read.
    """

    program: Program
    worlds: tuple[World, ...]
    failure: Failure | None = None
    rules: Rules = DEFAULT

    __repr__ = brief

    @property
    def executable(self) -> bool:
        """Return whether every tick was done."""
        return self.failure is None

    @property
    def final(self) -> World:
        """The last world reached."""
        return self.worlds[-1]

    def changes(self) -> tuple[Change, ...]:
        """Return the changes of each tick."""
        return tuple(now.changes(before) for before, now in zip(self.worlds, self.worlds[1:], strict=False))


def run(world: World, program: Program, rules: Rules = DEFAULT) -> Execution:
    """Run a bound program from a world, stopping at the first tick that can't be done.

    Examples:
        >>> execution = hearth.run(world, hearth.bind(program, world).apply(program))
        >>> execution.executable, len(execution.worlds), execution.final.holding()
        (True, 4, {0: (142,)})
    """
    world = ready(world, program, rules)
    worlds = [world]
    failure: Failure | None = None
    for number, steps in enumerate(_ticks(program)):
        result = alone(world, steps, rules) if isinstance(steps, Step) else together(world, steps, rules)
        if isinstance(result, Failure):
            failure = replace(result, tick=number)
            break
        world = result
        worlds.append(world)
    return Execution(program, tuple(worlds), failure, rules)


def final(world: World, program: Program, rules: Rules = DEFAULT) -> World | Failure:
    """Return only the end of a run, for callers that need no trace."""
    world = ready(world, program, rules)
    for number, steps in enumerate(_ticks(program)):
        result = alone(world, steps, rules) if isinstance(steps, Step) else together(world, steps, rules)
        if isinstance(result, Failure):
            return replace(result, tick=number)
        world = result
    return world


def ready(world: World, program: Program, rules: Rules = DEFAULT) -> World:
    """Return the world with its characters at places if a program moves them by metres or says where they stand, and by
    action set 3 with its further states.
    """
    if rules.consequences:
        world = widened(world)
    steps = program.steps
    if MOVES.keys().isdisjoint(map(_ACTION, steps)) and not any(map(_MODIFIERS, steps)):
        return world
    by_metres = any(step.action in MOVES or any(name in PLACED for name, _ in step.modifiers) for step in steps)
    return placed(world) if by_metres else world


_ACTION, _JOINS, _MODIFIERS = attrgetter("action"), attrgetter("joins"), attrgetter("modifiers")


def step(world: World, instructions: Mapping[int, Step | None], rules: Rules = DEFAULT) -> World | Failure:
    """One tick, done by the rule of `tick`, or, if one agent fails, not at all."""
    now, failures = tick(world, instructions, rules)
    return failures[min(failures)] if failures else now


def alone(world: World, instruction: Step, rules: Rules) -> World | Failure:
    """Return a tick in which one agent does something: the instruction, and by action set 3 what comes by itself."""
    result = act(world, instruction, rules)
    return advanced(world, result) if rules.consequences and type(result) is World else result


def act(world: World, instruction: Step, rules: Rules = DEFAULT) -> World | Failure:
    """One instruction of one agent."""
    number, name, objects = instruction.agent, instruction.action, instruction.objects
    agents = world.agents
    if not 0 <= number < len(agents):
        return _refused(world, instruction)
    placed_there = agents[number].pose is not None
    home, count = world.home, len(objects)
    if rules.consequences:
        if len(world.states) == _NARROW:
            world = widened(world)
        action = actions_of(home, placed_there).get(name)
    else:
        action = (EVERY if placed_there else ACTIONS).get(name)
    if action is None:
        return _refused(world, instruction)
    arity = home.knowledge.arity[name]
    if count != arity:
        return _miscounted(instruction, arity)
    try:
        o = home.index[objects[0].node] if count else -1  # type: ignore[index]
        s = home.index[objects[1].node] if count > 1 else -1  # type: ignore[index]
    except KeyError:
        return _unbound(world, instruction)
    result = action.rule(world, number, o, s, rules)
    if type(result) is World:
        if not placed_there and not instruction.modifiers:
            return result
        result = _in_place(world, result, instruction, o, s)
    if isinstance(result, Failure):
        # `dataclasses.replace` takes three times as long, and repairing is full of failures.
        used_up = rules.consequences and result.objects and is_gone(world, home.index[result.objects[0]])
        rest = (result.objects, result.names, result.expected, USED_UP if used_up else result.actual)
        return Failure(result.code, result.tick, number, name, *rest)
    return result


_NARROW = len(STATES)


def _in_place(before: World, done: World, instruction: Step, o: int, s: int) -> World | Failure:
    """Return the world after an instruction, with its character's place and the effects of its modifiers."""
    if before.agents[instruction.agent].pose is not None:
        done = followed(before, done, instruction.agent, instruction.action, o)
    return modified(before, done, instruction, o, s) if instruction.modifiers else done


def _ticks(program: Program) -> Iterable[Step | tuple[Step, ...]]:
    """Single steps as they are; only what happens together is grouped."""
    if not any(map(_JOINS, program.steps)):
        return program.steps
    return (steps[0] if len(steps) == 1 else steps for steps in program.ticks())


def tick(
    world: World, instructions: Mapping[int, Step | None], rules: Rules = DEFAULT
) -> tuple[World, dict[int, Failure]]:
    """One tick of several agents, each failing for itself.

    The rule: each instruction must be possible in the world as the tick begins; those that are, are done in order of
    agent number, and one that an earlier agent's change has made impossible is a CONFLICT. So of two who grab one cup
    the lower number gets it; an agent that walks to another arrives where that one has walked.

    Args:
        world: as the tick begins.
        instructions: agent number -> its instruction; None, like no entry, is doing nothing.
        rules: how actions are to be read.

    Returns:
        The world after the instructions that could be done, and the failures of the others.
    """
    failures: dict[int, Failure] = {}
    stopped: dict[int, int] = {}
    now = world = widened(world) if rules.consequences else world
    for agent, instruction in sorted(instructions.items()):
        if instruction is None:
            continue
        mine = instruction if instruction.agent == agent else replace(instruction, agent=agent)
        result = act(now, mine, rules)
        if now is not world and (isinstance(result, Failure) or not _only_moves(mine, world, now)):
            alone = act(world, mine, rules)
            result = alone if isinstance(alone, Failure) else _after_others(result, mine.action)
        if isinstance(result, Failure):
            failures[agent] = result
        elif rules.bodies and mine.action in MOVES:
            after = kept_apart(world, now, result, agent)
            if after is now and mine.objects:
                stopped[agent] = world.home.index[mine.objects[0].node]  # type: ignore[index]
            now = after
        else:
            now = seated_apart(result, agent) if rules.bodies else result
    now = _let_pass(world, now, instructions, stopped, rules) if stopped else now
    return advanced(world, now) if rules.consequences else now, failures


def _let_pass(
    before: World, world: World, instructions: Mapping[int, Step | None], stopped: Mapping[int, int], rules: Rules
) -> World:
    """Return the world after those have stepped aside that stop another and do nothing, or are stopped themselves.

    Of two that stop each other the higher number does.

    Args:
        before: at the start of the tick.
        world: after the instructions.
        instructions: of the tick.
        stopped: the characters that can't get on, each with the thing to which it walks.
        rules: how actions are read.
    """
    for agent, target in sorted(stopped.items()):
        for other in range(len(world.agents)):
            idle = instructions.get(other) is None
            if other != agent and (idle or (other in stopped and other > agent)) and is_beside(world, agent, other):
                world = kept_apart(before, world, stepped_aside(world, other, agent, target, rules), other)
    return world


def _only_moves(instruction: Step, before: World, now: World) -> bool:
    """Return whether an instruction stays impossible after a change.

    A move of metres that no door allowed.
    """
    return instruction.action in MOVES and before.states is now.states


def _after_others(result: World | Failure, action: str) -> World | Failure:
    if isinstance(result, World):
        return result
    actual = f"{result.code} after what the other did in this tick"
    return replace(result, code=Code.CONFLICT, expected=f"{action} still possible", actual=actual)


def together(world: World, steps: Iterable[Step], rules: Rules) -> World | Failure:
    """Several agents' instructions in one tick of a program: by the rule of `tick`, or, if one fails, not at all."""
    instructions: dict[int, Step | None] = {}
    for instruction in steps:
        if instruction.agent in instructions:
            return _twice(instruction)
        instructions[instruction.agent] = instruction
    now, failures = tick(world, instructions, rules)
    return failures[min(failures)] if failures else now


def _twice(instruction: Step) -> Failure:
    names = tuple(ref.name for ref in instruction.objects)
    expected, found = "one instruction an agent and tick", "two"
    return Failure(Code.CONFLICT, 0, instruction.agent, instruction.action, (), names, expected, found)


def unfit(world: World, instruction: Step) -> Failure | None:
    """Return the failure of an instruction that fails for any binding of its objects, or None.

    No agent has its number (UNKNOWN_AGENT), or its action takes another number of objects (WRONG_ARITY).
    """
    if not 0 <= instruction.agent < len(world.agents):
        return _refused(world, instruction)
    arity = world.home.knowledge.arity.get(instruction.action)
    return None if arity in (None, len(instruction.objects)) else _miscounted(instruction, arity)


def _refused(world: World, instruction: Step) -> Failure:
    names = tuple(ref.name for ref in instruction.objects)
    if not 0 <= instruction.agent < len(world.agents):
        found = f"{len(world.agents)} in this home"
        code, expected = Code.UNKNOWN_AGENT, f"an agent of number {instruction.agent}"
    elif instruction.action in world.home.knowledge.actions:
        code, expected, found = Code.NOT_SIMULATED, "one of the executed actions", "valid to write, never executed"
    else:
        code, expected, found = Code.UNKNOWN_ACTION, "an action of the grammar", instruction.action
    return Failure(code, 0, instruction.agent, instruction.action, (), names, expected, found)


def _miscounted(instruction: Step, arity: int) -> Failure:
    names = tuple(ref.name for ref in instruction.objects)
    expected, found = f"{arity} objects", str(len(names))
    return Failure(Code.WRONG_ARITY, 0, instruction.agent, instruction.action, (), names, expected, found)


def _unbound(world: World, instruction: Step) -> Failure:
    missing = [ref for ref in instruction.objects if ref.node not in world.home.index]
    found = "no node" if missing[0].node is None else f"{missing[0].node}, which the home lacks"
    names = tuple(ref.name for ref in missing)
    nodes = tuple(ref.node for ref in missing if ref.node is not None)
    expected = "an object bound to a node"
    return Failure(Code.UNBOUND, 0, instruction.agent, instruction.action, nodes, names, expected, found)
