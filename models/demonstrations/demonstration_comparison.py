"""Sketches from demonstrations compared with sketches from descriptions of the same programs (thesis A.4)."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.sketch_choice import ANNOTATED
from hearth.models.demonstrations.demonstration_data import Demonstrations, shown
from hearth.models.interface import Request, Steps
from hearth.models.model_registry import MODELS, restore
from hearth.models.text.text_words import words
from hearth.models.text_examples import Example, examples
from hearth.models.thesis_table_models import refuse_others
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.scoring.metrics.lcs import score_pairs

LENGTHS = (10, 20, 40)
"""Words of a description, at which groups end."""

ACTIVITIES = 15
"""Activities that are listed, those with the most programs."""


class Group(NamedTuple):
    """Some programs of the test.

    Attributes:
        group: an activity, or a range of words.
        programs: how many.
        lcs: the mean LCS of each model's sketches.
        easier: programs whose sketch is better from the demonstration than from the description.
    """

    group: str
    programs: int
    lcs: tuple[float, ...]
    easier: int


class Compared(NamedTuple):
    """Both kinds of sketches.

    Attributes:
        models: their names: the first reads demonstrations, the last descriptions.
        programs: of the test, with both.
        easier: those whose sketch is better from the demonstration.
        words_easier, words_others: words of their descriptions, and of the others', on average.
        by_words, by_activity: the same by group.
    """

    models: tuple[str, ...]
    programs: int
    easier: int
    words_easier: float
    words_others: float
    by_words: tuple[Group, ...]
    by_activity: tuple[Group, ...]


def compared(
    dataset: Dataset, split: str, models: Sequence[Path | str], beam: int = 1, sketches: str = ANNOTATED
) -> Compared:
    """Compare the sketches of the test's programs that have a demonstration and a description.

    Raises:
        HearthError: BAD_ARGUMENT, unless the models are of these two kinds, and of both; UNKNOWN_ID, if no program has
            a sketch, a description and a demonstration.
    """
    refuse_others("A.4", models)
    there = Demonstrations.of(dataset)
    found = examples(dataset, split, "test", originals=True, sketches=sketches)
    test = [(each, name) for each, name in shown(there, found) if each.sketch and each.description]
    if not test:
        message = f"no test program of `{split}` has a sketch, a description and a demonstration"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(dataset.folder))
    names, scores = zip(*_scores(models, there, test, beam), strict=True)
    rows = list(zip(test, zip(*scores, strict=True), strict=True))
    lengths = [len(words(each.description)) for each, _ in test]
    easier = [values[0] > values[-1] for _, values in rows]
    return Compared(
        names, len(test), sum(easier), _mean([n for n, is_easier in zip(lengths, easier, strict=True) if is_easier]),
        _mean([n for n, is_easier in zip(lengths, easier, strict=True) if not is_easier]),
        _groups(rows, lambda each: _range(len(words(each.description))), 0),
        _groups(rows, lambda each: each.title, ACTIVITIES),
    )  # fmt: skip


def _scores(
    models: Sequence[Path | str], there: Demonstrations, test: Sequence[tuple[Example, str]], beam: int
) -> list[tuple[str, list[float]]]:
    """Return the LCS of each model's sketches: those that read demonstrations first."""
    found: dict[str, list[tuple[str, list[float]]]] = {"film": [], "text": []}
    for model in models:
        name, trained = restore(model)
        entry = MODELS[name]
        if entry.output == "sketch":
            written = _written(entry.input, trained, there, test, beam)
            pairs = zip(written, (each.sketch for each, _ in test), strict=True)
            found[entry.input].append((name, [score.step for score in score_pairs(pairs)]))
    if not all(found.values()):
        message = "both a model of demonstrations and one of descriptions are needed"
        raise HearthError.of(Code.BAD_ARGUMENT, message,
                             suggestion="--model with a trained demo2sketch, and one with a desc2sketch")  # fmt: skip
    return [*found["film"], *found["text"]]


def _written(
    kind: str, trained: Any, there: Demonstrations, test: Sequence[tuple[Example, str]], beam: int
) -> Sequence[Steps]:
    if kind == "film":
        return trained.sketches([trained.see(there.pictures(name)) for _, name in test], beam)  # type: ignore[no-any-return]
    asked = [Request(name, each.title, each.description) for each, name in test]
    return trained.predict(asked, beam)  # type: ignore[no-any-return]


def _range(count: int) -> str:
    low = 1
    for end in LENGTHS:
        if count <= end:
            return f"{low} to {end} words"
        low = end + 1
    return f"{low} words or more"


def _groups(
    rows: Sequence[tuple[tuple[Example, str], Sequence[float]]], key: Callable[[Example], str], most: int
) -> tuple[Group, ...]:
    """Return groups by a key: in the order of the first words, or the largest `most`."""
    members: dict[str, list[Sequence[float]]] = {}
    for (each, _), values in rows:
        members.setdefault(key(each), []).append(values)
    found = [
        Group(name, len(some), tuple(_mean(column) for column in zip(*some, strict=True)),
              sum(values[0] > values[-1] for values in some))
        for name, some in members.items()
    ]  # fmt: skip
    if most:
        return tuple(sorted(found, key=lambda group: (-group.programs, group.group))[:most])
    return tuple(sorted(found, key=lambda group: int(group.group.split()[0])))


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0
