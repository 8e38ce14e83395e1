"""Tables 4.4 and 4.5: programs from descriptions, with the thesis's figures, ours and yardsticks."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from hearth.datasets.dataset import Dataset
from hearth.models.interface import Steps
from hearth.models.method_scores import Entrant, Row, scored_rows
from hearth.models.model_registry import restore
from hearth.models.prediction_files import completed
from hearth.models.text_examples import Example, examples
from hearth.models.thesis_table_models import refuse_others
from hearth.models.training_overlap import refuse_seen
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.scoring import baselines

TABLES = ("4.4", "4.5")

COLUMNS = {"action": "lcs_action", "object": "lcs_object", "step": "lcs_step", "mean": "lcs_mean",
           "executable": "executable", "f1": "f1_published", "goal": "goal", "goal_whole": "goal_whole"}  # fmt: skip
"""Columns of the table, and the scores that they show."""


def table(
    number: str,
    dataset: Dataset,
    split: str,
    models: Sequence[Path | str],
    *,
    beam: int = 1,
    repaired: bool = False,
    seed: int = 0,
) -> list[Row]:
    """Return the rows of a table, over the original programs of all test parts of a split.

    Args:
        number: 4.4 or 4.5.
        dataset: for 4.4 of synthesized programs, for 4.5 of people's.
        split: of the dataset.
        models: checkpoints; several of one model are its seeds.
        beam: as in `Trained.predict`.
        repaired: also a row for each model with its programs bound and repaired in their environments.
        seed: of yardsticks and intervals.

    Raises:
        HearthError: BAD_ARGUMENT, if the table is unknown, a model is of another kind, or was trained by another split
            on test programs; errors of `restore` and `examples`.
    """
    if number not in TABLES:
        message = f"no table `{number}` of programs from texts"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"there are {', '.join(TABLES)}")
    refuse_others(number, models)
    test = sorted(examples(dataset, split, "test", originals=True), key=lambda each: each.executions[0])
    for model in models:
        refuse_seen(model, dataset, split, [each.executions[0] for each in test])
    entrants = [*_yardsticks(dataset, split, test, seed), *_trained(models, test, beam)]
    if repaired:
        entrants += [_completed(dataset, each, test) for each in entrants if each.of == "ours"]
    names, groups = [each.executions[0] for each in test], [each.activity for each in test]
    return [*_of_thesis(number), *scored_rows(dataset, names, groups, entrants, COLUMNS, seed)]


def _of_thesis(number: str) -> Iterator[Row]:
    for each in baselines.THESIS:
        name, _, place = each.baseline.partition(", table ")
        if place == number:
            values = {column: getattr(each, column) for column in COLUMNS}
            yield Row(name, "thesis", {column: value for column, value in values.items() if value is not None})


def _yardsticks(dataset: Dataset, split: str, test: Sequence[Example], seed: int) -> Iterator[Entrant]:
    """Yield the methods without training, and another person's program for the same text, where there is one."""
    train = examples(dataset, split, "train", originals=True)
    yield Entrant("Empty program", "yardstick", [[()] * len(test)])
    given, asked = ([_plain(each) for each in part] for part in (train, test))
    for name, make in baselines.BASELINES.items():
        yield Entrant(name.capitalize(), "yardstick", [make(given, asked, seed, dataset.knowledge)])
    others = [_sibling(each, test) for each in test]
    if any(each is not None for each in others):
        yield Entrant("Another person, same text", "yardstick", [others])


def _plain(each: Example) -> baselines.Example:
    return baselines.Example(each.executions[0], f"{each.title} {each.description}", each.steps)


def _sibling(one: Example, test: Sequence[Example]) -> Steps | None:
    """Return the program of another example with the same text."""
    found = (each.steps for each in test if each is not one and _text(each) == _text(one))
    return next(found, None)


def _text(example: Example) -> tuple[str, str]:
    return example.title, example.description


def _trained(models: Sequence[Path | str], test: Sequence[Example], beam: int) -> list[Entrant]:
    answers: dict[str, list[list[Steps]]] = {}
    minutes: dict[str, list[float]] = {}
    for model in models:
        name, trained = restore(model)
        texts = {_text(each): each.request for each in test}
        known = dict(zip(texts, trained.predict(list(texts.values()), beam), strict=True))
        answers.setdefault(name, []).append([known[_text(each)] for each in test])
        spent = trained.checkpoint().trained.get("minutes")
        minutes.setdefault(name, []).extend([] if spent is None else [spent])
    return [Entrant(name, "ours", found, minutes[name]) for name, found in answers.items()]


def _completed(dataset: Dataset, entrant: Entrant, test: Sequence[Example]) -> Entrant:
    names = [each.executions[0] for each in test]
    answers = []
    for answer in entrant.answers:
        done = dict(completed(dataset, ((name, steps or ()) for name, steps in zip(names, answer, strict=True))))
        answers.append([done[name] for name in names])
    return Entrant(f"{entrant.method}, repaired", "ours", answers, entrant.minutes)
