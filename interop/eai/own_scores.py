"""Scores of a model's answers to our own tasks of the interface: goals, subgoals, plans and operators."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

from hearth.datasets.export.pddl_domain import planning_domain
from hearth.interop.eai.answer_texts import subgoals_of
from hearth.interop.eai.goal_interpretation import Counts
from hearth.interop.eai.own_tasks import actions_of, interpretation_counts, plan_verdict, start_of
from hearth.interop.eai.subgoal_decomposition import achieved, read_subgoals
from hearth.interop.eai.transition_modelling import compared, operators_of, predicates_in, whole
from hearth.kb.knowledge import Knowledge
from hearth.schemas.program import Program
from hearth.simulation.engine import run
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress

_ON, _CLOSE = re.compile(r"\bON\(([^(),]*),"), re.compile(r"\bCLOSE\(")


@dataclass
class OwnScores:
    """Sums over a model's answers.

    Attributes:
        goals: facts of goals that are right, wrong and missed.
        plans, subgoals: for each answer whether it runs, and whether it reaches the goal.
        operators: predicates of operators that are right, wrong and missed.
        not_scored: answers to other tasks or abilities.
    """

    goals: Counts = field(default_factory=Counts)
    plans: list[tuple[bool, bool]] = field(default_factory=list)
    subgoals: list[tuple[bool, bool]] = field(default_factory=list)
    operators: Counts = field(default_factory=Counts)
    not_scored: int = 0

    def add(self, task: Mapping[str, Any] | None, ability: str, answer: str, knowledge: Knowledge) -> None:
        """Add an answer to a task; None for a task that is not known."""
        if task is not None and ability == "goal_interpretation":
            self.goals = self.goals.plus(Counts(*interpretation_counts(task, answer)))
        elif task is not None and ability == "action_sequencing":
            self.plans.append(plan_verdict(task, answer, knowledge))
        elif task is not None and ability == "subgoal_decomposition":
            self.subgoals.append(subgoal_verdict(task, answer, knowledge))
        elif task is not None and ability == "transition_modeling":
            self.operators = self.operators.plus(operator_counts(task, answer, knowledge))
        else:
            self.not_scored += 1

    def figures(self) -> dict[str, Any]:
        """Return the figures by name, in per cent."""
        goal, operator = self.goals.scores(), self.operators.scores()
        plans, subgoals = (_shares(each) for each in (self.plans, self.subgoals))
        return {
            "goal_precision": goal[0], "goal_recall": goal[1], "goal_f1": goal[2],
            "plans": len(self.plans), "plans_that_run": plans[0], "plans_that_reach_the_goal": plans[1],
            "subgoal_answers": len(self.subgoals), "subgoals_that_run": subgoals[0],
            "subgoals_that_reach_the_goal": subgoals[1],
            "operator_precision": operator[0], "operator_recall": operator[1], "operator_f1": operator[2],
            "not_scored": self.not_scored,
        }  # fmt: skip


def _shares(verdicts: Iterable[tuple[bool, bool]]) -> tuple[float, float]:
    every = list(verdicts)
    runs, reaches = (round(100 * sum(each[k] for each in every) / max(len(every), 1), 2) for k in (0, 1))
    return runs, reaches


def subgoal_verdict(task: Mapping[str, Any], answer: str, knowledge: Knowledge) -> tuple[bool, bool]:
    """Return whether an answer's subgoals can be brought about in their order, and whether the goal then holds."""
    execution = start_of(task, knowledge)
    start = execution.worlds[0]
    texts = subgoals_of(answer)
    read = read_subgoals(list(map(_renamed, texts)), start) if texts else None
    goal = read_goal(task["goal"], start.home)
    runs = False
    for steps in () if read is None else achieved(start, read, knowledge, execution.rules):
        runs = True
        done = run(start, Program(steps=steps), execution.rules)
        if done.failure is None and Progress.of(goal, done).satisfied:
            return True, True
    return runs, False


def _renamed(text: str) -> str:
    """Return a subgoal with the interface's names of relations: ON of two things, and CLOSE."""
    return _CLOSE.sub("NEXT_TO(", _ON.sub(r"ONTOP(\1,", text))


@lru_cache(maxsize=512)
def _gold(actions: tuple[str, ...], knowledge: Knowledge) -> str:
    return planning_domain(knowledge, actions, loose=False)


def operator_counts(task: Mapping[str, Any], answer: str, knowledge: Knowledge) -> Counts:
    """Return the predicates of an answer's operators that are right, wrong and missed, by the engine's own domain."""
    domain = _gold(tuple(actions_of(task)), knowledge)
    wanted, found = operators_of(domain), operators_of(answer)
    names = {name for operator in wanted.values() for text in operator for name in predicates_in(whole(text))}
    known = dict.fromkeys(names | {name for each in found.values() for text in each for name in _named(text)}, "")
    lower = {name.lower(): operator for name, operator in found.items()}
    counts = Counts()
    for name, operator in wanted.items():
        given = lower.get(name.lower(), ("()", "()"))
        for text, right in zip(given, operator, strict=True):
            counts = counts.plus(compared(text, right, known))
    return counts


def _named(text: str) -> Iterable[str]:
    try:
        return list(predicates_in(whole(text)))
    except ValueError:
        return ()
