"""The quality of goal inference during an episode: F1 over time (figures 7-3b, C-4), log loss, calibration."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from statistics import fmean
from typing import Any

from hearth.challenges.episodes import Known, Record
from hearth.challenges.helper_beliefs import Beliefs, beliefs
from hearth.challenges.metrics import mean
from hearth.challenges.result_files import Results
from hearth.challenges.tasks import Task
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, spread, unseen

SHARES = (0.0, 0.1, 0.25, 0.5, 0.75)
"""Parts of the time that the main agent needs alone, at which beliefs are compared."""

BINS = 10

LEAST = 1e-9
"""The probability that stands for 0 in a logarithm."""


@dataclass(frozen=True)
class Question:
    """An episode whose helper is asked for its beliefs."""

    task: Task
    record: Record
    helper: str
    known: Known


def answer(question: Question) -> Beliefs:
    """Return the helper's beliefs in each tick."""
    return beliefs(question.task, question.record, question.helper, question.known())


def inference(results: Results, known: Known, workers: int = 1, seen: Seen = unseen) -> dict[str, Any]:
    """F1 and log loss (nats) at `SHARES` of the main agent's time alone, by goal set too, and the calibration.

    Calibration compares the probability that the goal has a predicate with how often it has it: for each tenth of
    probabilities their mean, the share that is true, and how many there are; `error` is their mean distance.

    Raises:
        HearthError: BAD_ARGUMENT: the helper infers no goals, or there are no episodes of one.
    """
    tasks = {task.id: task for task in results.header.suite.tasks}
    means = results.outcomes(False)
    helped = [each for each in results.records if each.helped and each.actions and means.get(each.task)]
    if not helped:
        message = "no episode with a helper, of a task that was done alone, too"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="`challenge run TASKS --helper nopa --out FILE`")
    alone = {task: fmean(each["length"] for each in some) for task, some in means.items()}
    questions = [Question(tasks[each.task], each, results.header.lineup.helper, known) for each in helped]
    found = list(spread(answer, questions, workers, seen))
    curves = [_curve(each, alone[record.task]) for each, record in zip(found, helped, strict=True)]
    sets = [tasks[record.task].sets[0] for record in helped]
    rows = [{"share": share, **_at(curves, number)} for number, share in enumerate(SHARES)]
    by_set = {
        name: [
            _at([c for c, each in zip(curves, sets, strict=True) if each == name], n)["f1"] for n in range(len(SHARES))
        ]
        for name in dict.fromkeys(sets)
    }
    return {"episodes": len(found), "over_time": rows, "f1_by_set": by_set, **calibration(found)}


def _curve(found: Beliefs, alone: float) -> list[tuple[float, float]]:
    """F1 and log loss at `SHARES`; once the goal is reached, as at the end."""
    last = len(found.moments) - 1
    moments = [found.moments[min(last, int(share * alone))] for share in SHARES]
    return [(each.f1, -math.log(max(LEAST, each.truth))) for each in moments]


def _at(curves: Sequence[Sequence[tuple[float, float]]], number: int) -> dict[str, float | None]:
    f1, loss = (mean([curve[number][column] for curve in curves]) for column in (0, 1))
    return {"f1": round(f1.value, 4), "f1_se": f1.error, "log_loss": round(loss.value, 4), "log_loss_se": loss.error}


def calibration(found: Sequence[Beliefs]) -> dict[str, Any]:
    """Return the calibration of predicates' probabilities over all ticks (see `inference`)."""
    pairs = [
        (probability, wanted > 0)
        for each in found
        for moment in each.moments
        for probability, wanted in zip(moment.wanted, each.goal, strict=True)
    ]
    bins: list[dict[str, float]] = []
    for number in range(BINS):
        here = [pair for pair in pairs if min(BINS - 1, int(pair[0] * BINS)) == number]
        if here:
            said, true = fmean(pair[0] for pair in here), fmean(pair[1] for pair in here)
            bins.append({"probability": round(said, 4), "true": round(true, 4), "cases": len(here)})
    off = sum(abs(each["probability"] - each["true"]) * each["cases"] for each in bins) / max(1, len(pairs))
    return {"calibration": bins, "calibration_error": round(off, 5)}
