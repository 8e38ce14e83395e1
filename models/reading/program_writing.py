"""Programs for a reading: planned in a home, tidied, run, and compared with the request."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from hearth.models.interface import Steps
from hearth.models.reading.instruction_reading import Reading
from hearth.models.reading.request_table import acts_of
from hearth.models.reading.spoken_things import ANY_ACT, Act
from hearth.repair.runnable_predictions import Completion, complete
from hearth.schemas.failures import Code, Failure
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.engine import Execution, run
from hearth.simulation.goals import Progress
from hearth.simulation.rules import Rules
from hearth.simulation.world.bits import indices
from hearth.simulation.world.states import CLOSED, OPEN
from hearth.simulation.world.world import World

OPENS = "Open"
CLOSES = "Close"
WAITS = "Wait"
GRABS = "Grab"
HANDS = 2
PUTS = "PutBack"
TOGGLES = ("switched", "moved")
"""Groups of acts that undo one another; one of them alone holds for a thing."""

PUT_DOWN = ("kitchen_counter", "dining_table", "kitchen_table", "table", "coffee_table", "desk")
"""Furniture on which a thing is put down to have a hand free."""


class Written(NamedTuple):
    """A program for a reading in a home.

    Attributes:
        acts: that were asked for.
        execution: of the program.
        sources: for each step, the number of the act that it does; -1 for one that only prepares others.
        left_out: required acts that cannot be done there, with the reason.
        unmet: the part of the goals that does not hold at the end.
    """

    acts: tuple[Act, ...]
    execution: Execution
    sources: tuple[int, ...]
    left_out: tuple[tuple[Act, Failure], ...]
    unmet: Goal

    @property
    def does_all(self) -> bool:
        """Return whether everything that was asked is done."""
        return not self.left_out and not self.unmet.counts and bool(self.execution.program.steps)


def sketch_of(reading: Reading) -> Steps:
    """Return the acts as steps of one agent."""
    return tuple(Step(act.action, act.objects) for act in reading.acts)


def write_program(reading: Reading, world: World, rules: Rules) -> Written:
    """Return the program that does what was read, planned act by act by the repairs, without what was forbidden.

    Should the whole not run as its parts did, it is planned as a whole.
    """
    acts = _wanted(
        _seated_last(_fetched_first([act for act in reading.acts if not is_forbidden(act, reading.forbidden)]))
    )
    planned = _planned(acts, world, rules)
    execution = run(world, Program(steps=planned.steps), rules)
    if execution.failure is not None:
        planned = _planned_whole(acts, world, rules)
        execution = run(world, Program(steps=planned.steps), rules)
    execution, sources = _tidied(execution, planned.sources, reading, world, rules)
    left_out = tuple((acts[number], failure) for number, failure in planned.left_out if not acts[number].optional)
    return Written(acts, execution, sources, left_out, _unmet(Goal.of(*reading.goals), execution))


def is_forbidden(act: Act | Step, forbidden: Sequence[Act]) -> bool:
    """Return whether an act is one of those that are not to be done: of one without things, any of its name."""
    nodes = set(_nodes(act.objects))
    return any(ban.action in (act.action, ANY_ACT) and nodes >= set(_nodes(ban.objects)) for ban in forbidden)


class _Plan(NamedTuple):
    """Steps, the number of the act that each does or -1, and the acts that cannot be done."""

    steps: Steps
    sources: tuple[int, ...]
    left_out: tuple[tuple[int, Failure], ...]


def _planned(acts: Sequence[Act], world: World, rules: Rules) -> _Plan:
    """Return a plan made act by act, each from the world in which the one before it leaves the home."""
    steps: list[Step] = []
    sources: list[int] = []
    left_out: list[tuple[int, Failure]] = []
    for number, act in enumerate(acts):
        done = complete((Step(act.action, act.objects),), world, world.home.knowledge, rules)
        if done.left_out and done.left_out[0][1].code is Code.NO_FREE_HAND:
            done = _with_hands(act, world, rules) or done
        if done.left_out:
            left_out.append((number, done.left_out[0][1]))
            continue
        for step, source in zip(done.execution.program.steps, done.sources, strict=True):
            if not steps or step != steps[-1] or step.action == WAITS:  # looked for once more
                steps.append(step)
                sources.append(number if source >= 0 else -1)
        world = done.execution.final
    return _Plan(tuple(steps), tuple(sources), tuple(left_out))


def _with_hands(act: Act, world: World, rules: Rules) -> Completion | None:
    """Return an act after a held thing was put down; None where that does not help."""
    home, agent = world.home, world.agents[0]
    held = [i for i in range(len(home)) if agent.held >> i & 1]
    held.sort(key=lambda i: home.ids[i] not in _nodes(act.objects))
    surfaces = [i for name in PUT_DOWN for i in indices(home.instances(name))]
    for thing in held:
        for surface in surfaces[:2]:
            down = Step(PUTS, (_ref(world, thing), _ref(world, surface)))
            done = complete((down, Step(act.action, act.objects)), world, home.knowledge, rules)
            if not done.left_out:
                return done._replace(sources=tuple(source - 1 if source > 0 else -1 for source in done.sources))
    return None


def _ref(world: World, node: int) -> ObjectRef:
    return ObjectRef(world.home.classes[node], node + 1, world.home.ids[node])


def _planned_whole(acts: Sequence[Act], world: World, rules: Rules) -> _Plan:
    done = complete(tuple(Step(act.action, act.objects) for act in acts), world, world.home.knowledge, rules)
    left_out = [(number, failure) for step, failure in done.left_out
                for number in [n for n, act in enumerate(acts) if act.action == step.action][:1]]  # fmt: skip
    return _Plan(done.execution.program.steps, done.sources, tuple(left_out))


def _wanted(acts: Sequence[Act]) -> tuple[Act, ...]:
    """Return acts without those already done, where nothing was done to their things since: a brake on repetition."""
    found: list[Act] = []
    for act in _in_hands(acts):
        same = max((n for n, each in enumerate(found) if _is_same(each, act)), default=-1)
        since = found[same + 1 :] if same >= 0 else ()
        if _is_so(found, act) or (act.action in acts_of("dropped") and _is_put(found, act)):
            continue
        if act.action == WAITS or same < 0 or any(_concerns(each, act) for each in since):
            found.append(act)
    return tuple(found)


def _fetched_first(acts: Sequence[Act]) -> Sequence[Act]:
    """Return acts in which a thing to read or drink in a seat is taken before the agent sits."""
    found = list(acts)
    for at, act in enumerate(acts):
        uses = next((each for each in acts[at + 1 :] if each.action in acts_of("seated") | acts_of("rises")), None)
        if act.action not in acts_of("seats") or uses is None or uses.action in acts_of("rises") or not uses.objects:
            continue
        thing = uses.objects[:1]
        if not any(_nodes(each.objects)[:1] == _nodes(thing) for each in acts[: acts.index(uses)]):
            found.insert(found.index(act), Act(GRABS, thing, uses.words))
    return found


def _seated_last(acts: Sequence[Act]) -> Sequence[Act]:
    """Return acts in which the agent switches a screen on before it sits down to watch."""
    found = [act for at, act in enumerate(acts) if not at or not _is_same(acts[at - 1], act) or act.action == WAITS]
    for at in range(len(found) - 2):
        seat, switch, watch = found[at : at + 3]
        is_one = switch.words == watch.words and watch.action in acts_of("watched") and switch.objects == watch.objects
        if seat.action in acts_of("seats") and is_one and switch.action in acts_of("switched"):
            found[at : at + 2] = [switch, seat]
    return found


def _is_so(before: Sequence[Act], act: Act) -> bool:
    """Return whether a thing already is as an act makes it, by the last act that bears on that."""
    kinds = next((kinds for kinds in map(acts_of, TOGGLES) if act.action in kinds), None)
    if kinds is None or not act.objects:
        return False
    last = next(
        (
            each
            for each in reversed(before)
            if each.action in kinds and _nodes(each.objects)[:1] == _nodes(act.objects)[:1]
        ),
        None,
    )
    return last is not None and last.action == act.action and last.objects == act.objects


def _is_put(before: Sequence[Act], act: Act) -> bool:
    """Return whether the last act before one that lets a thing go has put that thing somewhere."""
    last = next((each for each in reversed(before) if _nodes(each.objects)[:1] == _nodes(act.objects)[:1]), None)
    return last is not None and last.action in acts_of("put")


def _in_hands(acts: Sequence[Act]) -> Iterator[Act]:
    """Yield acts without the grabs for which there is no hand, of things that a later act takes anyhow."""
    held: list[int | None] = []
    for at, act in enumerate(acts):
        nodes = _nodes(act.objects)
        if act.action == GRABS:
            if len(held) >= HANDS and any(nodes[:1] == _nodes(each.objects)[:1] for each in acts[at + 1 :]):
                continue
            held += [nodes[0]]
        elif act.action not in acts_of("kept") and nodes:
            held = [node for node in held if node != nodes[0]]
        yield act


def _is_same(one: Act, other: Act) -> bool:
    return one.action == other.action and _nodes(one.objects) == _nodes(other.objects)


def _concerns(one: Act, other: Act) -> bool:
    """Return whether an act is about things of another; about a posture, where the other has no thing."""
    return bool({ref.node for ref in one.objects} & {ref.node for ref in other.objects}) or not other.objects


def _nodes(objects: Sequence[ObjectRef]) -> tuple[int | None, ...]:
    return tuple(ref.node for ref in objects)


def _unmet(goal: Goal, execution: Execution) -> Goal:
    return Progress.at(goal, execution.final).unmet() if goal.counts else goal


def _tidied(
    execution: Execution, sources: tuple[int, ...], reading: Reading, world: World, rules: Rules
) -> tuple[Execution, tuple[int, ...]]:
    """Return the run of a program that also closes what it opened only to reach what is in it."""
    forbidden = {(act.action, ref.node) for act in reading.forbidden for ref in act.objects}
    forbidden |= {(CLOSES, ref.node) for act in reading.acts if act.action == OPENS for ref in act.objects}
    for at, node in reversed(list(_opened(execution, sources))):
        if (CLOSES, node) in forbidden:
            continue
        found = _closed(execution, sources, at, node, world, rules)
        if found is not None:
            execution, sources = found
    return execution, sources


def _opened(execution: Execution, sources: Sequence[int]) -> Iterator[tuple[int, int]]:
    """Yield the furniture that a repair opened and nothing closes: the number of the step, and the node."""
    steps = execution.program.steps
    home = execution.final.home
    for at, (step, source) in enumerate(zip(steps, sources, strict=True)):
        if step.action != OPENS or source >= 0 or not step.objects or step.objects[0].node is None:
            continue
        node = step.objects[0].node
        index = home.index[node]
        later = any(each.action in (OPENS, CLOSES) and each.objects[0].node == node for each in steps[at + 1 :])
        is_open = execution.final.states[OPEN] >> index & 1 and not home.doors >> index & 1
        if is_open and not later:
            yield at, node


def _closed(
    execution: Execution, sources: tuple[int, ...], opened: int, node: int, world: World, rules: Rules
) -> tuple[Execution, tuple[int, ...]] | None:
    """Return a run in which a thing is closed after its last use; None where it fails."""
    steps = execution.program.steps
    name = steps[opened].objects[0]
    index = world.home.index[node]
    inside = [at for at in range(opened, len(steps)) if _uses(execution, steps[at], at, node, index)]
    at = max(inside, default=opened) + 1
    closing = Step(CLOSES, (name,))
    changed = (*steps[:at], closing, *steps[at:])
    again = run(world, Program(steps=changed), rules)
    if again.failure is not None or not again.final.states[CLOSED] >> index & 1:
        return None
    return again, (*sources[:at], -1, *sources[at:])


def _uses(execution: Execution, step: Step, at: int, node: int, index: int) -> bool:
    """Return whether a step is about a thing, or about one that is in it before."""
    from hearth.simulation.world import edge_rows

    world = execution.worlds[at]
    refs = [ref.node for ref in step.objects if ref.node is not None]
    return node in refs or any(edge_rows.inside(world, world.home.index[ref]) >> index & 1 for ref in refs)


def repeats(steps: Steps) -> bool:
    """Return whether a program does the same steps over again, besides waiting and walking.

    A list of two steps or more that comes twice in a row is a repetition, and so is a step that follows itself.
    """
    acts = [step for step in steps if step.action != WAITS]
    for size in range(1, len(acts) // 2 + 1):
        for at in range(len(acts) - 2 * size + 1):
            if acts[at : at + size] == acts[at + size : at + 2 * size]:
                return True
    return False


UNDERSTOOD = Code.NOT_UNDERSTOOD
