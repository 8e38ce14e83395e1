"""The agreement of a judge with the engine: a judge that says the same of right and wrong cases knows nothing."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

from hearth.analysis.sketch_agreement import kappa
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episodes import Known, Record, replayed, start_of
from hearth.challenges.metrics import difference_interval, share_interval
from hearth.challenges.tasks import Task
from hearth.challenges.verification import read_whole
from hearth.datasets.dataset import Dataset
from hearth.envs.text_agent import plain
from hearth.llm.judge import Case, Judgement
from hearth.llm.prompt_pages import page
from hearth.models.text.retrieval import text_of
from hearth.models.text_examples import requests
from hearth.schemas.program import Step
from hearth.schemas.syntax import print_step
from hearth.scoring.dataset_scores import score_given


def program_cases(predicted: Path, folder: Path, limit: int | None = None) -> Iterator[Case]:
    """Yield the predicted programs of a dataset's executions; right is a program that runs and reaches the goal.

    Executions without a goal, or whose goal holds at the start, are left out: a program of no steps would be right.

    Args:
        predicted: a file of predictions.
        folder: of the dataset.
        limit: the first cases only.

    Raises:
        HearthError: those of `score_given`.
    """
    dataset = Dataset.open(folder)
    found = [each for each in score_given(dataset, predicted) if each.goal and each.goal.left][:limit]
    names = [each.pair.id for each in found]
    asked = {each.id: each for share in requests(dataset, names, worlds=False) for each in share}
    for each in found:
        ran = each.execution is not None and each.execution.executable
        reached = each.goal is not None and each.goal.reached
        text = asked[each.pair.id]
        steps = tuple(print_step(line) if isinstance(line, Step) else line for line in each.pair.predicted or ())
        yield Case(each.pair.id, text_of(text.title, text.description), steps, ran and reached)


def episode_cases(results: Path, known: Known, limit: int | None = None) -> Iterator[Case]:
    """Yield the episodes of a file of results, each replayed; right is one in which the goal was reached.

    Args:
        results: the file.
        known: gives the knowledge.
        limit: the first cases only.

    Raises:
        HearthError: those of `read_whole` and `replayed`.
    """
    found = read_whole(results)
    tasks = {task.id: task for task in found.header.suite.tasks}
    for record in [each for each in found.records if each.end is None][:limit]:
        name = f"{record.task}/{record.seed}/{'helped' if record.helped else 'alone'}"
        steps, right = _replayed(tasks[record.task], record, known)
        yield Case(name, tasks[record.task].instruction, steps, right)


def _replayed(task: Task, record: Record, known: Known) -> tuple[tuple[str, ...], bool]:
    """Return the steps of an episode, a walk of many ticks as one, and whether its goal was reached."""
    start = start_of(task, known(), None if record.helped else 1)
    ticks, _, progress = replayed(challenge(task.challenge), task, record, start)
    words, agents = page("judge"), len(start.agents)
    lines = []
    for tick in ticks:
        for number, step in sorted(tick.instructions.items()):
            line = plain(step) if agents == 1 else f"Agent {number}: {plain(step)}"
            lines.append(words.said("refused", step=line) if number in tick.failures else line)
    return tuple(line for line, _ in groupby(lines)), progress[-1].satisfied


def agreement(judgements: Sequence[Judgement]) -> dict[str, Any]:
    """Return how far a judge's verdicts are the engine's.

    `informed` is the share of right cases that it accepts less that of wrong ones: 0 of any judge that does not look,
    whatever it says. `from` and `to` are its interval of 95 %; a judge whose interval has 0 in it was not shown to know
    anything. Of cases that the engine all judges alike, there is none.
    """
    said = [(each.says, each.case.right) for each in judgements if each.says is not None]
    right, wrong = ([says for says, true in said if true is kind] for kind in (True, False))
    found: dict[str, Any] = {
        "cases": len(judgements),
        "verdicts": len(said),
        "right_by_engine": len(right),
        "right_accepted": sum(right),
        "wrong_by_engine": len(wrong),
        "wrong_accepted": sum(wrong),
        "agree": _share(sum(says is true for says, true in said), len(said)),
        "agree_of_one_answer": _share(max(len(right), len(wrong)), len(said)),
        "kappa": None,
        "informed": None,
        "from": None,
        "to": None,
    }
    if said:
        found["agree_from"], found["agree_to"] = (round(x, 3) for x in share_interval(found["agree"], len(said)))
    if right and wrong:
        one, other = sum(right) / len(right), sum(wrong) / len(wrong)
        low, high = difference_interval(one, len(right), other, len(wrong))
        found |= {"informed": round(one - other, 3), "from": round(low, 3), "to": round(high, 3)}
        found["kappa"] = kappa([(tuple(bool(says) for says, _ in said), tuple(true for _, true in said))])
    return {**found, "finding": _finding(found)}


def _share(part: int, number: int) -> float | None:
    return round(part / number, 3) if number else None


def _finding(found: dict[str, Any]) -> str:
    """Return in words whether the judge knows anything."""
    if found["informed"] is None:
        return "not known: the engine finds all of these cases right, or all wrong"
    accepted = found["right_accepted"] + found["wrong_accepted"]
    if accepted in (0, found["verdicts"]):
        return f"a null judge: it says {'yes' if accepted else 'no'} of every case"
    if found["from"] <= 0 <= found["to"]:
        return "no better than chance, as far as these cases show"
    return "better than chance" if found["informed"] > 0 else "worse than chance"
