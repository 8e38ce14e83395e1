"""The value of a larger corpus: retrieval of programs by description, trained on its first part and on all of it."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hearth.analysis.corpus_statistics import Corpus, gather
from hearth.datasets.format.ids import activity_id
from hearth.datasets.format.split_columns import SplitProgram, SplitPrograms
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.build import FIRST, corpus
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.schemas.syntax import print_step
from hearth.scoring.baselines import Example, nearest_description
from hearth.scoring.bootstrap import intervals
from hearth.scoring.line_sequences import read, steps_of
from hearth.scoring.metrics import lcs

SCORES = ("action", "object", "step", "mean")
"""Normalised LCS of the retrieved program with the description's own, and the mean (table 4.5)."""

_HELD_OUT = 5
"""One activity of this number is tested."""


def before_and_after(known: Knowledge, seed: int = 0, tested: Sequence[str] | None = None) -> dict[str, Any]:
    """Scores of retrieval by TF-IDF, trained on the corpus's first part and on all of it, on the same tests.

    No training program has an activity of the tests, nearly the steps or nearly the text of one of them.

    Args:
        known: actions and objects.
        seed: of the held-out activities and of the intervals.
        tested: other sources, as people's, whose described programs are the tests; else those of a fifth of the first
            part's activities.

    Returns:
        `tested`, `activities`, and under `trained_on`, for `first part` and `whole corpus`, the number of `programs`
        and `scores`: mean and 95% interval of each of `SCORES`.
    """
    first = _described(gather(corpus(FIRST), known))
    every = _described(gather(corpus(), known))
    if tested is None:
        test = [one for one in first if derive(seed, "retrieval", one.activity) % _HELD_OUT == 0]
    else:
        test = _described(gather(tested, known))
    if not test:
        raise HearthError.of(Code.EMPTY, "there is not one described program to test")
    apart = _apart(test, [*first, *every])
    trained = {"first part": first, "whole corpus": every}
    return {
        "tested": len(test),
        "activities": len({one.activity for one in test}),
        "trained_on": {
            name: _scored([one for one in found if one.program_id in apart], test, known, seed)
            for name, found in trained.items()
        },
    }


def _described(found: Corpus) -> list[SplitProgram]:
    """Return the programs with a description, in the order of their ids."""
    programs = [
        SplitProgram(
            one.program_id,
            activity_id(one.title),
            "",
            None,
            tuple(print_step(step) for step in one.steps),
            f"{one.title} {found.descriptions[one.description_id]}",
        )
        for one in found.programs
        if found.descriptions.get(one.description_id)
    ]
    return sorted(programs, key=lambda one: one.program_id)


def _apart(test: Sequence[SplitProgram], train: Sequence[SplitProgram]) -> set[str]:
    """Return the ids of the training programs that are of other activities than the tests and not near duplicates of
    any.
    """
    # Both corpora may have programs of one id.
    every = [replace(one, program_id=str(number).zfill(9)) for number, one in enumerate((*test, *train))]
    known = SplitPrograms.of(every)
    tested, trained = np.arange(len(test)), np.arange(len(test), len(every))
    like = known.steps.among(known.steps.around(tested), trained)
    # A text between two, like both, keeps them together.
    like |= known.texts.among(known.texts.like(known.texts.around(tested)), trained)
    activities = {one.activity for one in test}
    return {
        one.program_id
        for one, is_like in zip(train, like.tolist(), strict=True)
        if one.activity not in activities and not is_like
    }


def _scored(train: Sequence[SplitProgram], test: Sequence[SplitProgram], known: Knowledge, seed: int) -> dict[str, Any]:
    found = nearest_description(list(_examples(train)), list(_examples(test)), seed, known)
    own = [one.steps for one in _examples(test)]
    scores = lcs.score_pairs(zip(found, own, strict=True))
    columns = {name: [float(getattr(score, name)) for score in scores] for name in SCORES}
    return {
        "programs": len(train),
        "scores": {name: value._asdict() for name, value in intervals(columns, seed).items()},
    }


def _examples(programs: Iterable[SplitProgram]) -> Iterable[Example]:
    return (Example(one.program_id, one.description, steps_of(read(list(map(str, one.steps))))) for one in programs)
