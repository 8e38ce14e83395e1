"""The table of the interface's models: published figures, the same computed anew by its rules, and by ours."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from hearth.interop.eai import action_sequencing, goal_interpretation, subgoal_decomposition
from hearth.interop.eai.goal_interpretation import Counts
from hearth.interop.eai.operator_planning import OperatorPlanning
from hearth.interop.eai.subgoal_decomposition import outcomes
from hearth.interop.eai.transition_modelling import Operators
from hearth.interop.eai.wheel import ABILITIES, Wheel
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

SOURCE = "embodied-agent-interface.github.io, website/data/virtualhome_total_benchmark.json, 23 February 2026"
"""The place of the published figures."""

NEAR = 1.0
"""Points by which a figure may differ from the published one."""

Row = dict[str, Any]
"""A model's figure in an ability: `model`, `ability`, `measure`, `published`, `theirs`, `ours`, `agrees`.

A figure of subgoals that differs from the published one has `low` and `high`, which it takes by the choices that the
interface leaves to chance, and `by_chance`, the tasks whose verdict depends on them.
"""


@cache
def published() -> dict[str, dict[str, str]]:
    """Return the published figures by model."""
    text = (files("hearth.interop.eai") / "published_figures.csv").read_text(encoding="utf-8")
    return {row["model"]: row for row in csv.DictReader(text.splitlines())}


def table(
    wheel: Wheel,
    knowledge: Knowledge,
    models: Collection[str] = (),
    abilities: Collection[str] = (),
    planner: OperatorPlanning | None = None,
) -> Iterator[Row]:
    """Yield the figures of models, a model after the other.

    Args:
        wheel: with stored answers.
        knowledge: of its homes.
        models: the models to judge, by their names or the wheel's; all if empty.
        abilities: names of `ABILITIES`; all if empty.
        planner: plans with the models' operators; without it their success is left out.

    Raises:
        HearthError: MISSING_FILE: the wheel has no answers; UNKNOWN_ID: no such model.
    """
    there = wheel.models("action_sequencing")
    if not there:
        raise HearthError.of(Code.MISSING_FILE, "the wheel has no stored answers of models", file=str(wheel.path),
                             suggestion="virtualhome-eval 0.1.1 has them")  # fmt: skip
    known = published()
    names = {known[model]["name"].lower() if model in known else model: model for model in there}
    wanted = [names.get(each.lower(), each) for each in models] or list(there)
    for model in wanted:
        if model not in there:
            raise HearthError.of(Code.UNKNOWN_ID, f"no model `{model[:60]}`", suggestion=f"one of {', '.join(there)}")
        for ability in abilities or ABILITIES:
            yield from _figures(wheel, knowledge, model, ability)
            if ability == "transition_modeling" and planner is not None:
                outcomes = list(filter(None, map(planner.planned, wheel.answers(ability, model))))
                share = round(100 * sum(each.solved for each in outcomes) / max(len(outcomes), 1), 2)
                yield _row(model, ability, "planner success", "transition_planner", share, None)


def _figures(wheel: Wheel, knowledge: Knowledge, model: str, ability: str) -> Iterator[Row]:
    answers = [each for each in wheel.answers(ability, model) if each.task in wheel.tasks]
    if ability == "action_sequencing":
        verdicts = [action_sequencing.judged(wheel, each, knowledge) for each in answers]
        found = action_sequencing.totals(verdicts, wheel)
        yield _row(model, ability, "success", "action_success", found.success, found.success_ours)
        yield _row(model, ability, "execution", "action_execution", found.execution, found.execution_ours)
        yield from (_row(model, ability, fault, "", share, None) for fault, share in found.faults.items())
    elif ability == "goal_interpretation":
        judged = (goal_interpretation.judged(wheel, each, knowledge) for each in answers)
        theirs, ours = goal_interpretation.totals(judged)
        yield from _scores(model, ability, "goal_f1", theirs["all"], ours["all"])
        for kind in goal_interpretation.KINDS:
            yield _row(model, ability, f"{kind} F1", "", theirs[kind].scores()[2], ours[kind].scores()[2])
    elif ability == "subgoal_decomposition":
        found_subgoals = [subgoal_decomposition.judged(wheel, each, knowledge) for each in answers]
        success, execution, own_success, own_runs = subgoal_decomposition.shares(found_subgoals)
        rows = [_row(model, ability, "success", "subgoal_success", success, own_success),
                _row(model, ability, "execution", "subgoal_execution", execution, own_runs)]  # fmt: skip
        if any(row["agrees"] is False for row in rows):
            _add_chances(rows, {each.task: outcomes(wheel, each, knowledge) for each in answers})
        yield from rows
    elif ability == "transition_modeling":
        operators, theirs_sum, ours_sum = Operators(wheel), Counts(), Counts()
        for each in answers:
            one, other = operators.judged(each)
            theirs_sum, ours_sum = theirs_sum.plus(one), ours_sum.plus(other)
        yield from _scores(model, ability, "transition_f1", theirs_sum, ours_sum)


def _add_chances(rows: list[Row], by_task: Mapping[str, set[tuple[bool, bool]]]) -> None:
    """Add to success and execution of subgoals their range over the interface's choices by chance, and the tasks.

    Args:
        rows: of success, then of execution.
        by_task: execution and success for each choice.
    """
    for row, place in zip(rows, (1, 0), strict=True):
        found = {task: {each[place] for each in verdicts} for task, verdicts in by_task.items()}
        low, high = (100 * sum(fit(verdicts) for verdicts in found.values()) / len(found) for fit in (all, any))
        row |= {"low": round(low, 2), "high": round(high, 2),
                "by_chance": [task for task, verdicts in found.items() if len(verdicts) > 1]}  # fmt: skip


def _scores(model: str, ability: str, column: str, theirs: Counts, ours: Counts) -> Iterator[Row]:
    pairs = zip(("precision", "recall", "F1"), theirs.scores(), ours.scores(), strict=True)
    for measure, one, other in pairs:
        yield _row(model, ability, measure, column if measure == "F1" else "", one, other)


def _row(model: str, ability: str, measure: str, column: str, theirs: float, ours: float | None) -> Row:
    said = published().get(model, {}).get(column, "")
    figure = float(said) if said else None
    agrees = None if figure is None else abs(figure - theirs) <= NEAR
    name = published().get(model, {}).get("name", model)
    return {"model": name, "ability": ability, "measure": str(measure), "published": figure, "theirs": theirs,
            "ours": ours, "agrees": agrees}  # fmt: skip
