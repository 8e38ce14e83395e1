"""Action sequencing: whether the plans of a model run and reach the goal, by the interface's rules and by ours."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from hearth.interop.eai.answer_texts import Pairs, plan_as_scored, plan_of
from hearth.interop.eai.task_worlds import TaskWorld, bound, task_world
from hearth.interop.eai.wheel import Answer, Task, Wheel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program, Step
from hearth.scoring.metrics.executability import is_already_so
from hearth.simulation.engine import act, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import EVOLVING_GRAPH
from hearth.simulation.world.world import World

ARITY = {
    **dict.fromkeys(
        ["DRINK", "EAT", "CUT", "TOUCH", "LOOKAT", "LOOKAT_SHORT", "LOOKAT_MEDIUM", "LOOKAT_LONG", "WATCH", "READ",
         "TYPE", "PUSH", "PULL", "MOVE", "SQUEEZE", "RINSE", "SCRUB", "WASH", "GRAB", "SWITCHOFF", "SWITCHON", "CLOSE",
         "FIND", "WALK", "OPEN", "POINTAT", "PUTOBJBACK", "RUN", "SIT", "TURNTO", "WIPE", "PUTON", "PUTOFF", "GREET",
         "DROP", "LIE"], 1),
    **dict.fromkeys(["SLEEP", "WAKEUP", "STANDUP"], 0),
    **dict.fromkeys(["PUTBACK", "PUTIN", "POUR"], 2),
}  # fmt: skip
"""The interface's actions and their number of arguments; PLUGIN and PLUGOUT are missing there."""


class Fault(StrEnum):
    """The class of an answer that is not executed."""

    PARSING = "parsing"
    HALLUCINATION = "hallucination"
    ARGUMENTS = "argument number"
    WRONG_ORDER = "wrong order"
    MISSING_STEP = "missing step"
    AFFORDANCE = "affordance"
    ADDITIONAL_STEP = "additional step"


@dataclass(frozen=True, slots=True)
class Verdict:
    """A plan judged.

    Attributes:
        task: its number.
        executed, reached: by the interface's rules.
        reached_backwards: the same, where the goal's actions are taken in the other order, as hash order may.
        is_gold: whether it is the gold program, which the interface counts as executed and not as successful.
        runs, succeeds: by ours: every step is done, and then the whole goal holds.
        faults: by the interface's rules; superfluous steps are skipped there and counted.
        why: the failure by ours, in code.
    """

    task: str
    executed: bool
    reached: bool
    reached_backwards: bool
    is_gold: bool
    runs: bool
    succeeds: bool
    faults: tuple[Fault, ...] = ()
    why: str = ""


def counted(task: Task) -> bool:
    """Return whether the interface counts a task: it looks for one relation alone, so that none with two can hold."""
    return len(task.relations) <= 1


def judged(wheel: Wheel, answer: Answer, knowledge: Knowledge) -> Verdict:
    """Return the verdict on an answer."""
    there = task_world(wheel, answer.task, knowledge)
    runs, succeeds, why = _by_ours(there, plan_of(answer.text), knowledge)
    plan = plan_as_scored(answer.text)
    fault = _unread(plan, there)
    if fault is not None:
        return Verdict(answer.task, False, False, False, False, runs, succeeds, (fault,), why)
    steps = [_bound(pair, there, knowledge) for pair in plan or []]
    gold = [(step.action, tuple(ref.node for ref in step.objects)) for step in there.gold]
    is_gold = [(step.action, tuple(ref.node for ref in step.objects)) for step in steps] == gold
    if is_gold:
        return Verdict(answer.task, True, False, False, True, runs, succeeds, (), why)
    world, done, faults = _skipping(there.start, steps)
    stopped = any(each is not Fault.ADDITIONAL_STEP for each in faults)
    texts = "".join(f"[{action.upper()}] " for action, _ in (plan[number] for number in done)) if plan else ""
    reached = [_holds(there.task, world, texts, actions) for actions in (there.task.actions, there.task.actions[::-1])]
    return Verdict(answer.task, not stopped, reached[0], reached[1], False, runs, succeeds, tuple(faults), why)


def _unread(plan: Pairs | None, there: TaskWorld) -> Fault | None:
    """Return why a plan is not executed by the interface's rules."""
    if not plan:
        return Fault.PARSING
    if any(action.upper() not in ARITY or any(name not in there.names for name in names) for action, names in plan):
        return Fault.HALLUCINATION
    return Fault.ARGUMENTS if any(len(names) != ARITY[action.upper()] for action, names in plan) else None


def _bound(pair: tuple[str, list[str]], there: TaskWorld, knowledge: Knowledge) -> Step:
    action, names = pair
    return bound(action, [(name, there.names[name]) for name in names], knowledge)


def _skipping(world: World, steps: Sequence[Step]) -> tuple[World, list[int], list[Fault]]:
    """Return the world, the steps that were done and the faults; superfluous steps are skipped."""
    done: list[int] = []
    faults: list[Fault] = []
    worlds = [world]
    for number, step in enumerate(steps):
        result = act(worlds[-1], step, EVOLVING_GRAPH)
        if isinstance(result, World):
            worlds.append(result)
            done.append(number)
            continue
        faults.append(fault_of(step, result, worlds))
        if faults[-1] is not Fault.ADDITIONAL_STEP:
            break
    return worlds[-1], done, faults


UNAFFORDED = (Code.NOT_AFFORDED, Code.NOT_SIMULATED, Code.NOTHING_TO_EAT)


def fault_of(step: Step, failure: Failure, worlds: Sequence[World]) -> Fault:
    """Return the class of a failed step: superfluous, out of order (it was possible before), or a step is missing."""
    if failure.code in UNAFFORDED:
        return Fault.AFFORDANCE
    if is_already_so(step.action, failure.code, worlds[0].home.knowledge) or failure.code is Code.HELD_ALREADY:
        return Fault.ADDITIONAL_STEP
    before = any(isinstance(act(world, step, EVOLVING_GRAPH), World) for world in worlds[:-1])
    return Fault.WRONG_ORDER if before else Fault.MISSING_STEP


def _holds(task: Task, world: World, done: str, actions: Sequence[str]) -> bool:
    """Return whether a goal holds by the interface's rules: its actions are looked for in the text of the steps."""
    index = world.home.index
    if not all(row["id"] in index and world.has_state(row["id"], row["state"]) for row in task.states):
        return False
    if task.relations:
        row = task.relations[0]
        there = (row["from_id"], row["relation_type"], row["to_id"]) in set(world.edges())
        if int(there) < len(task.relations):
            return False
    place = 0
    for each in actions:
        found = [(done.find(word, place), word) for word in each.upper().replace(" ", "").split("|")]
        at, word = next(((at, word) for at, word in found if at >= 0), (-1, ""))
        if at < 0:
            return False
        place = at + len(word)
    return True


def _by_ours(there: TaskWorld, plan: Pairs | None, knowledge: Knowledge) -> tuple[bool, bool, str]:
    """Return whether every step is done, whether the whole goal then holds, and the code of the failure."""
    if not plan:
        return False, False, str(Code.SYNTAX)
    for action, names in plan:
        if knowledge.action(action) is None:
            return False, False, str(Code.UNKNOWN_ACTION)
        if any(name not in there.names for name in names):
            return False, False, str(Code.UNKNOWN_OBJECT)
    program = Program(steps=tuple(_bound(pair, there, knowledge) for pair in plan))
    execution = run(there.start, program, EVOLVING_GRAPH)
    if execution.failure is not None:
        return False, False, str(execution.failure.code)
    goal = read_goal({"vh_goal": there.task.record["vh_goal"]}, there.start.home)
    return True, Progress.of(goal, execution).satisfied, ""


@dataclass
class Totals:
    """Sums over the verdicts on a model, in per cent.

    Attributes:
        count, count_ours: tasks by the interface's rules, and by ours: those with a goal.
        success: by the interface's rules. It keeps a goal's actions in a set, so that the order of two follows from a
            hash; the published figures are those of the order that fails.
        success_in_order: the same with actions in the goal's order.
        execution: of plans.
        success_ours, execution_ours: by ours.
        faults: per cent of tasks by class.
    """

    count: int = 0
    count_ours: int = 0
    success: float = 0.0
    success_in_order: float = 0.0
    execution: float = 0.0
    success_ours: float = 0.0
    execution_ours: float = 0.0
    faults: dict[str, float] = field(default_factory=dict)


def totals(verdicts: Iterable[Verdict], wheel: Wheel) -> Totals:
    """Return the sums over the verdicts on a model's answers."""
    every = list(verdicts)
    theirs = [each for each in every if counted(wheel.tasks[each.task])]
    ours = [each for each in every if not wheel.tasks[each.task].empty]
    faults = Counter(fault for each in theirs for fault in dict.fromkeys(each.faults))
    ends = [
        (each.reached, each.reached_backwards) if len(wheel.tasks[each.task].actions) > 1 else (each.reached,) * 2
        for each in theirs
    ]
    return Totals(
        len(theirs),
        len(ours),
        _share([all(each) for each in ends]),
        _share([each.reached for each in theirs]),
        _share([each.executed for each in theirs]),
        _share([each.succeeds for each in ours]),
        _share([each.runs for each in ours]),
        {str(fault): round(100 * faults[fault] / max(len(theirs), 1), 2) for fault in Fault},
    )


def _share(values: Sequence[bool]) -> float:
    return round(100 * sum(values) / len(values), 2) if values else 0.0
