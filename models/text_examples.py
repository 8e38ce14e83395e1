"""Examples for models: pairs of text and program of a published dataset, by split and part."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.row_conversion import program_of
from hearth.datasets.format.sketch_choice import ANNOTATED, sketches_query
from hearth.datasets.format.splits import RULES
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.interface import Request, Steps
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import derive
from hearth.simulation import rules
from hearth.storage.files import value_digest

SHARE = 10
"""One of how many activities of `train` are for validation where the split has no part of that name."""

FEWEST = 20
"""Validation examples of a split by home: where its activities leave fewer, and fewer than one in `SHARE`, they are of
`train`."""

AT_ONCE = 250
"""Requests in memory at a time, with their worlds."""


@dataclass(frozen=True, slots=True)
class Example:
    """A program with its text.

    Attributes:
        program_id: as in the dataset.
        activity: its id.
        title: the activity as written.
        description: the text.
        steps: without nodes.
        executions: the ids of its executions in the part, sorted.
        keep: for each step whether the sketch keeps it; empty without a sketch. An annotated sketch goes before others.
        origin: `written`, `crowd`, `release`, `augmented` and so on.
    """

    program_id: str
    activity: str
    title: str
    description: str
    steps: Steps
    executions: tuple[str, ...] = ()
    keep: tuple[bool, ...] = ()
    origin: str = ""

    @property
    def sketch(self) -> Steps:
        """Return the steps that its sketch keeps; none without a sketch."""
        return tuple(step for step, keeps in zip(self.steps, self.keep, strict=False) if keeps)

    @property
    def request(self) -> Request:
        """Return the example without its program: all that a model may see."""
        return Request(self.program_id, self.title, self.description, self.sketch)


@dataclass(frozen=True, slots=True)
class Corpus:
    """The examples that a model is trained on.

    Attributes:
        dataset: the source of the examples, and of other inputs that a model needs.
        split: by which they were parted.
        train: to learn from.
        validation: to decide when to stop; their activities are not in `train`.
        shared: the part of `train` that is in the split's test parts, too; see `shared`.
        instead: how many examples the split's own part `validation` has of other activities, where they were too few.
        writes: the output that models learn to write from it.
    """

    dataset: Dataset
    split: str
    train: tuple[Example, ...]
    validation: tuple[Example, ...]
    shared: Mapping[str, int] = field(default_factory=dict)
    instead: int | None = None
    writes: Literal["program", "sketch"] = "program"

    def checked(self, *, sketches: bool = False) -> tuple[Example, ...]:
        """Return the examples for validation, of which there are some.

        Args:
            sketches: some have a sketch, too.

        Raises:
            HearthError: BAD_ARGUMENT, if there are none: nothing would tell which weights are the best.
        """
        if not any(any(each.keep) or not sketches for each in self.validation):
            message = f"split `{self.split}` has no {'sketches' if sketches else 'examples'} for validation"
            suggestion = "train on a dataset of more activities, or a model that needs no validation, such as `nearest`"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=suggestion)
        return self.validation

    def of_sketches(self) -> Corpus:
        """Return the corpus with sketches in the place of programs; programs without one are left out."""
        train, validation = (
            tuple(replace(each, steps=each.sketch, keep=()) for each in part if each.sketch)
            for part in (self.train, self.validation)
        )
        return replace(self, train=train, validation=validation, writes="sketch")

    @property
    def facts(self) -> dict[str, Any]:
        """Return the facts about this corpus that a checkpoint records."""
        counts = {"train": len(self.train), "validation": len(self.validation)}
        facts = {**facts_of(self.dataset), "split": self.split, **counts}
        if self.instead is not None:
            facts["validation_of_train_instead_of"] = self.instead
        return {**facts, **{f"{name}_of_test": count for name, count in self.shared.items()}}


def facts_of(dataset: Dataset) -> dict[str, Any]:
    """Return the facts about its training dataset that a checkpoint records."""
    version = dataset.manifest.get("version", "")
    return {"dataset": version, "digest": value_digest(dataset.manifest["files"])}


_PROGRAMS = """
    SELECT p.program_id, p.activity_id, p.title, p.description, p.steps, p.origin, any_value(k.keep) AS keep,
        list_sort(list(s.execution_id)) AS runs
    FROM splits s JOIN programs p USING (program_id) JOIN executions e USING (execution_id)
    LEFT JOIN ({sketches}) k ON k.program_id = p.program_id
    WHERE s.split = $split AND starts_with(s.part, $part) AND e.executable AND {where}
    GROUP BY ALL ORDER BY p.program_id
"""


def examples(
    dataset: Dataset, split: str, part: str, *, originals: bool = False, sketches: str = ANNOTATED
) -> tuple[Example, ...]:
    """Return the programs of a part with their texts, by id.

    Args:
        dataset: a published dataset.
        split: one of its splits.
        part: prefix of the split's parts (`test` is all tests).
        originals: leave out augmented programs, which have the texts of the programs they were made from.
        sketches: `annotated` or `inferred`: which go before the others.

    Raises:
        HearthError: UNKNOWN_ID, if the part has none.
    """
    found = _read(dataset, split, part, originals, sketches)
    if not found:
        there = dataset.rows("SELECT DISTINCT split || ' ' || part FROM splits WHERE part IS NOT NULL ORDER BY 1")[1]
        message = f"no programs in part `{part}` of split `{split}`"
        suggestion = f"there are {', '.join(name for (name,) in there)}"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(dataset.folder), suggestion=suggestion)
    return found


def _read(dataset: Dataset, split: str, part: str, originals: bool, sketches: str) -> tuple[Example, ...]:
    query = _PROGRAMS.format(sketches=sketches_query(sketches), where="p.parent_id IS NULL" if originals else "true")
    return tuple(example_of(row) for row in dataset.read(query, {"split": split, "part": part}))


def example_of(row: Any) -> Example:
    """Return the example of a row of programs with its texts and steps."""
    texts = (row["title"] or "", row["description"] or "")
    keep = tuple(row["keep"] or ())
    return Example(
        row["program_id"], row["activity_id"], *texts, program_of(row).steps, tuple(row["runs"]), keep, row["origin"]
    )


def corpus(dataset: Dataset, split: str, *, originals: bool = True, seed: int = 0, sketches: str = ANNOTATED) -> Corpus:
    """Return the training and validation examples of a split.

    Where the split has no part `validation`, one in ten activities of `train` is taken out for it. Of a split by
    activity or home, validation has no activities of `train`; where that leaves hardly any, those of `train` are taken
    here, too. One that came with its source is as it is.

    Raises:
        HearthError: UNKNOWN_ID, if the split has no training examples.
    """
    train = examples(dataset, split, "train", originals=originals, sketches=sketches)
    common = shared(train, _read(dataset, split, "test", originals, sketches))
    validation = _read(dataset, split, "validation", originals, sketches)
    if not validation:
        return Corpus(dataset, split, *carved(train, seed), common)
    activities = {each.activity for each in train} if split in RULES else set()
    others = tuple(each for each in validation if each.activity not in activities)
    if len(others) < FEWEST and len(others) * SHARE < len(validation):
        return Corpus(dataset, split, *carved(train, seed), common, len(others))
    return Corpus(dataset, split, train, others, common)


def shared(train: Sequence[Example], test: Sequence[Example]) -> dict[str, int]:
    """Return the numbers of titles, descriptions and step lists of test examples that training examples have, too.

    All are 0 in splits by activity. In splits by home the same program may be in several homes.
    """
    return {
        name: len({get(each) for each in test if get(each)} & {get(each) for each in train})
        for name, get in _SEEN.items()
    }


def of_new_titles(dataset: Dataset, trained_on: Dataset, split: str) -> set[str]:
    """Return the ids of a dataset's executions whose titles no training program of another dataset has, ignoring case.

    Args:
        dataset: with the executions.
        trained_on: the other one; `dataset` may be a release of other people's programs.
        split: of `trained_on`.

    Raises:
        HearthError: UNKNOWN_ID, if the other dataset has no training part; EMPTY, if it has every title.
    """
    known = {each.title.lower() for each in examples(trained_on, split, "train", originals=True)}
    query = "SELECT e.execution_id, p.title FROM executions e JOIN programs p USING (program_id)"
    new = {name for name, title in dataset.rows(query)[1] if (title or "").lower() not in known}
    if not new:
        message = "every title was in training"
        raise HearthError.of(Code.EMPTY, message, file=str(dataset.folder))
    return new


_SEEN: dict[str, Callable[[Example], Any]] = {
    "titles": lambda each: each.title.lower(),
    "descriptions": lambda each: each.description.lower(),
    "step_lists": lambda each: each.steps,
}


def carved(train: Iterable[Example], seed: int) -> tuple[tuple[Example, ...], tuple[Example, ...]]:
    """Split training examples by activity and return those to train on and those for validation.

    Of two activities or more, each of the two has at least one.
    """
    given = tuple(train)
    drawn = {each.activity: derive(seed, "validation", each.activity) for each in given}
    order = sorted(drawn, key=lambda name: (drawn[name] % SHARE, drawn[name], name))
    count = sum(number % SHARE == 0 for number in drawn.values())
    taken = {*order[: min(max(count, 1), len(order) - 1)]} if order else set()
    stays = tuple(each for each in given if each.activity not in taken)
    return stays, tuple(each for each in given if each.activity in taken)


def requests(
    dataset: Dataset, names: Sequence[str], *, worlds: bool, sketches: str = ANNOTATED
) -> Iterator[list[Request]]:
    """Yield the known inputs of executions, without their programs, in batches of at most 250.

    Args:
        dataset: a published dataset.
        names: ids of executions.
        worlds: whether the requests have the world at the start.
        sketches: `annotated` or `inferred`: which go before the others.
    """
    known = {row["program_id"]: tuple(row["keep"]) for row in dataset.read(sketches_query(sketches))}
    homes = opened(str(dataset.folder))[1]
    for first in range(0, len(names), AT_ONCE):
        share = []
        for case in stored_cases(dataset, names[first : first + AT_ONCE]):
            keep = known.get(case["program_id"], ())
            steps = program_of(case).steps
            sketch = tuple(step for step, keeps in zip(steps, keep, strict=False) if keeps)
            world = start_of(case["environment"], case["home"], homes) if worlds else None
            texts = (case["title"] or "", case["description"] or "")
            share.append(Request(case["execution_id"], *texts, sketch, world, rules.RULES[case["rules"]]))
        yield share
