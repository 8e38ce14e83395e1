"""Running programs: ticks of instructions, each giving a new world or saying why not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program, Step
from hearth.simulation.actions.common import Action
from hearth.simulation.actions.registry import ACTIONS
from hearth.simulation.change import Change
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world import World


@dataclass(frozen=True, slots=True)
class Execution:
    """What became of a program.

    Attributes:
        program: what was run, bound to node ids.
        worlds: the start, then the world after each tick that was done. They share all that is equal.
        failure: why it stopped before its end, if it did; nothing of the failed tick is done.
    """

    program: Program
    worlds: tuple[World, ...]
    failure: Failure | None = None

    @property
    def executable(self) -> bool:
        """Whether every tick was done."""
        return self.failure is None

    @property
    def final(self) -> World:
        """The last world reached."""
        return self.worlds[-1]

    def changes(self) -> tuple[Change, ...]:
        """What each tick changed."""
        return tuple(now.changes(before) for before, now in zip(self.worlds, self.worlds[1:], strict=False))


def run(world: World, program: Program, rules: Rules = DEFAULT) -> Execution:
    """Run a bound program from a world, stopping at the first tick that can't be done."""
    worlds = [world]
    failure: Failure | None = None
    for number, tick in enumerate(_ticks(program)):
        result = act(world, tick, rules) if isinstance(tick, Step) else _together(world, tick, rules)
        if isinstance(result, Failure):
            failure = replace(result, tick=number)
            break
        world = result
        worlds.append(world)
    return Execution(program, tuple(worlds), failure)


def final(world: World, program: Program, rules: Rules = DEFAULT) -> World | Failure:
    """Only the end of a run, for who needs no trace."""
    for number, tick in enumerate(_ticks(program)):
        result = act(world, tick, rules) if isinstance(tick, Step) else _together(world, tick, rules)
        if isinstance(result, Failure):
            return replace(result, tick=number)
        world = result
    return world


def step(world: World, instructions: Mapping[int, Step | None], rules: Rules = DEFAULT) -> World | Failure:
    """One tick: agent number -> its instruction; None, like no entry, is doing nothing."""
    steps = [replace(s, agent=agent) for agent, s in sorted(instructions.items()) if s is not None]
    if not steps:
        return world
    return act(world, steps[0], rules) if len(steps) == 1 else _together(world, steps, rules)


def act(world: World, instruction: Step, rules: Rules = DEFAULT) -> World | Failure:
    """One instruction of one agent."""
    action = ACTIONS.get(instruction.action)
    if action is None or instruction.agent >= len(world.agents):
        return _refused(world, instruction)
    index = world.home.index
    objects = instruction.objects
    try:
        o = index[objects[0].node] if objects else -1  # type: ignore[index]
        s = index[objects[1].node] if len(objects) > 1 else -1  # type: ignore[index]
    except KeyError:
        return _unbound(world, instruction)
    result = action(world, instruction.agent, o, s, rules)
    if result.__class__ is Failure:
        return replace(result, agent=instruction.agent, action=instruction.action)
    return result


def _ticks(program: Program) -> Iterable[Step | tuple[Step, ...]]:
    """Single steps as they are; only what happens together is grouped."""
    if not any(step.joins for step in program.steps):
        return program.steps
    return (tick[0] if len(tick) == 1 else tick for tick in program.ticks())


def _together(world: World, steps: Iterable[Step], rules: Rules) -> World | Failure:
    """Several agents' instructions in one tick.

    The rule: each must be possible in the world as the tick begins; then they are done in order of agent number, and
    one that an earlier agent's change has made impossible is a CONFLICT. A failed tick changes nothing.
    """
    ordered = sorted(steps, key=lambda s: s.agent)
    for instruction in ordered:
        alone = act(world, instruction, rules)
        if isinstance(alone, Failure):
            return alone
    now = world
    for instruction in ordered:
        result = act(now, instruction, rules)
        if isinstance(result, Failure):
            actual = f"{result.code} after what the other did in this tick"
            return replace(result, code=Code.CONFLICT, expected=f"{instruction.action} still possible", actual=actual)
        now = result
    return now


def _refused(world: World, instruction: Step) -> Failure:
    names = tuple(ref.name for ref in instruction.objects)
    if instruction.agent >= len(world.agents):
        found = f"{len(world.agents)} in this home"
        code, expected = Code.UNKNOWN_AGENT, f"an agent of number {instruction.agent}"
    elif instruction.action in world.home.knowledge.actions:
        code, expected, found = Code.NOT_SIMULATED, "one of the executed actions", "valid to write, never executed"
    else:
        code, expected, found = Code.UNKNOWN_ACTION, "an action of the grammar", instruction.action
    return Failure(code, 0, instruction.agent, instruction.action, (), names, expected, found)


def _unbound(world: World, instruction: Step) -> Failure:
    missing = [ref for ref in instruction.objects if ref.node not in world.home.index]
    found = "no node" if missing[0].node is None else f"{missing[0].node}, which the home lacks"
    names = tuple(ref.name for ref in missing)
    nodes = tuple(ref.node for ref in missing if ref.node is not None)
    expected = "an object bound to a node"
    return Failure(Code.UNBOUND, 0, instruction.agent, instruction.action, nodes, names, expected, found)


def executed(name: str) -> Action:
    """The function that executes an action.

    Raises:
        KeyError: the action is not executed.
    """
    return ACTIONS[name]
