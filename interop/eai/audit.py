"""An audit of the interface: goals and verdicts that are wrong, each with a program that proves it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from hearth.interop.eai.action_sequencing import ARITY, Fault, Verdict, counted, judged
from hearth.interop.eai.answer_texts import Pairs, plan_as_scored, plan_of
from hearth.interop.eai.task_worlds import TaskWorld, task_world
from hearth.interop.eai.wheel import Answer, Wheel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_step
from hearth.simulation.engine import Execution, run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import REPLAY
from hearth.simulation.world.world import World


class Finding(NamedTuple):
    """Something wrong.

    Attributes:
        kind: what is wrong, in words.
        task: its number.
        title: of the task.
        model: whose answer proves it; "gold" for the gold program, "" where nothing needs to be done.
        goal: the goal.
        program: the steps that prove it.
    """

    kind: str
    task: str
    title: str
    model: str
    goal: str
    program: tuple[str, ...]


EMPTY = "the goal asks for nothing"
AT_START = "the goal holds before anything is done"
SEVERAL = "the goal has several relations, of which the scorer looks for one: no plan can reach it"
UNREACHED = "the gold program does not reach the goal"
UNLIKE = "the goal's two forms disagree about the gold program"
GOLD = "a plan equal to the gold program counts as executed and not as successful"
STOPPED = "the goal counts as reached, though the plan stopped before its end"
PASSED_OVER = "steps without arguments are passed over: another plan is judged than the model wrote"
PLUGS = "PLUGIN and PLUGOUT count as invented, though gold programs have them"
BY_HASH = "the verdict depends on the order in which a hash puts the goal's two actions"


def wrong_goals(wheel: Wheel, knowledge: Knowledge) -> Iterator[Finding]:
    """Yield the goals that are wrong, or that the scorer cannot judge."""
    for number in wheel.tasks:
        there = task_world(wheel, number, knowledge)
        for kind in _faults_of_goal(there):
            proof = tuple(map(print_step, there.gold)) if kind in (UNREACHED, UNLIKE, SEVERAL) else ()
            yield _finding(kind, there, "gold" if proof else "", proof)


def _faults_of_goal(there: TaskWorld) -> Iterator[str]:
    task = there.task
    if task.empty:
        yield EMPTY
        return
    if not counted(task):
        yield SEVERAL
    done = run(there.start, Program(steps=there.gold), REPLAY)
    if _reached(there, run(there.start, Program(), REPLAY), "vh_goal"):
        yield AT_START
    whole, formula = _reached(there, done, "vh_goal"), _reached(there, done, "tl_goal")
    if not whole:
        yield UNREACHED
    if formula is not None and whole != formula:
        yield UNLIKE


def _reached(there: TaskWorld, execution: Execution, form: str) -> bool | None:
    """Return whether a run reaches a goal in one of its forms; None where that form can't be read."""
    try:
        goal = read_goal({form: there.task.record[form]}, there.start.home)
    except (HearthError, KeyError):
        return None
    return execution.failure is None and Progress.of(goal, execution).satisfied


def wrong_verdicts(wheel: Wheel, knowledge: Knowledge, model: str) -> Iterator[Finding]:
    """Yield the verdicts on a model's plans that are wrong by the interface's rules, and why."""
    for answer in wheel.answers("action_sequencing", model):
        if answer.task not in wheel.tasks or wheel.tasks[answer.task].empty:
            continue
        verdict, there = judged(wheel, answer, knowledge), task_world(wheel, answer.task, knowledge)
        plan = plan_of(answer.text)
        for kind in _faults_of_verdict(there.start, answer, verdict, plan, counted(there.task)):
            yield _finding(kind, there, model, _printed(plan))


def _faults_of_verdict(
    start: World, answer: Answer, verdict: Verdict, plan: Pairs | None, judges: bool
) -> Iterator[str]:
    if verdict.succeeds and not judges:
        yield SEVERAL
    if not judges:
        return
    if verdict.is_gold and verdict.succeeds:
        yield GOLD
    if verdict.reached and not verdict.executed:
        yield STOPPED
    scored = plan_as_scored(answer.text)
    if plan is not None and scored != plan and (verdict.executed, verdict.reached) != (verdict.runs, verdict.succeeds):
        yield PASSED_OVER
    words = {action.upper() for action, _ in plan or ()}
    if Fault.HALLUCINATION in verdict.faults and verdict.succeeds and words - ARITY.keys() <= {"PLUGIN", "PLUGOUT"}:
        yield PLUGS
    if verdict.reached != verdict.reached_backwards:
        yield BY_HASH


def _printed(plan: Pairs | None) -> tuple[str, ...]:
    return tuple(" ".join([f"[{action}]", *(f"<{name}>" for name in names)]) for action, names in plan or ())


def _finding(kind: str, there: TaskWorld, model: str, program: tuple[str, ...]) -> Finding:
    facts = [f"{row['state']}({row['class_name']}.{row['id']})" for row in there.task.states]
    facts += [f"{row['relation_type']}({row['from_id']}, {row['to_id']})" for row in there.task.relations]
    goal = " then ".join([*there.task.actions, " and ".join(facts)] if facts else there.task.actions)
    return Finding(kind, there.task.id, there.task.title, model, goal, program)


def page_of(findings: Iterable[Finding]) -> str:
    """Return a page of findings in Markdown, by kind, each with its goal and the steps that prove it."""
    kinds: dict[str, list[Finding]] = {}
    for finding in findings:
        kinds.setdefault(finding.kind, []).append(finding)
    lines = ["# Wrong goals and wrong verdicts", ""]
    lines += [f"- {kind}: {len(those)}" for kind, those in kinds.items()]
    for kind, those in kinds.items():
        lines += ["", f"## {kind[:1].upper()}{kind[1:]}"]
        for finding in those:
            by = f" ({finding.model})" if finding.model else ""
            steps = [f"    {step}" for step in finding.program]
            lines += ["", f"Task {finding.task}, {finding.title}{by}. Goal: `{finding.goal or 'nothing'}`", "", *steps]
    return "\n".join(lines) + "\n"
