"""Tables 5.2 to 5.5: programs from sketches and graphs, with the thesis's figures, ours and yardsticks."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.sketch_choice import ANNOTATED
from hearth.models.demonstrations.demo_sketches import demonstrated
from hearth.models.demonstrations.demonstration_data import Demonstrations
from hearth.models.evaluation import by_group
from hearth.models.interface import Request, Steps
from hearth.models.method_scores import Entrant, Row, scored_rows
from hearth.models.model_registry import MODELS, restore
from hearth.models.prediction_files import predict
from hearth.models.text_examples import requests
from hearth.models.thesis_table_models import refuse_others
from hearth.models.training_overlap import refuse_seen
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.scoring import baselines
from hearth.scoring.metrics.lcs import score_pairs
from hearth.storage.parallel import Seen, unseen

TABLES = ("5.2", "5.3", "5.4", "5.5")

PREDICTED = ("5.4", "5.5")
"""Tables of sketches that are predicted, from texts and from demonstrations."""

COLUMNS = {"lcs": "lcs_step", "lcs_instances": "lcs_step_instances",
           "f1_relation": "f1_relation_published", "f1_state": "f1_state_published", "f1": "f1_published",
           "goal": "goal", "goal_fraction": "goal_fraction",
           "executable": "executable", "parsable": "parsable", "goal_whole": "goal_whole"}  # fmt: skip
"""Columns of the tables, and the scores that they show; the thesis's LCS is by instance. Those of
`PREDICTED` have `sketch`, too."""

MOST = 400
"""Test executions; of more, a sample spread over all of them."""

Writer = Callable[[Sequence[Request]], Sequence[Steps]]


class Method(NamedTuple):
    """A method that answers requests.

    Attributes:
        name: of its row; methods of one name are seeds of one.
        of: `yardstick` or `ours`.
        write: programs for requests.
        minutes: of training.
        sketches: by execution, in the place of the given ones.
    """

    name: str
    of: str
    write: Writer
    minutes: float | None = None
    sketches: Mapping[str, Steps] | None = None


def table(
    number: str,
    dataset: Dataset,
    split: str,
    models: Sequence[Path | str],
    *,
    beam: int = 1,
    sketches: str = ANNOTATED,
    most: int = MOST,
    seed: int = 0,
    seen: Seen = unseen,
) -> list[Row]:
    """Return the rows of a table over the test parts of a split.

    Args:
        number: 5.2 and 5.3, from given sketches, over originals and augmented programs; 5.4, from sketches that models
            of texts write, over originals; 5.5, from sketches that models of demonstrations write, over executions that
            have one.
        dataset: with the executions.
        split: of the dataset.
        models: checkpoints; several of one model are its seeds.
        beam: as in `Trained.predict`.
        sketches: which are given.
        most: executions at most.
        seed: of yardsticks and intervals.
        seen: reports progress.

    Raises:
        HearthError: BAD_ARGUMENT, if the table is unknown, a model is of another kind or was trained by another split
            on test programs, or none of 5.4 or 5.5 writes its sketches.
    """
    if number not in TABLES:
        message = f"no table `{number}` of programs from sketches"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"there are {', '.join(TABLES)}")
    refuse_others(number, models)
    every = [each for each in baselines.examples(dataset, split, "test", number == "5.4", sketches) if each.sketch]
    if number == "5.5":
        there = Demonstrations.of(dataset)
        every = [each for each in every if each.execution_id in there.files]
    test = every[:: max(1, -(-len(every) // most))]
    train = baselines.examples(dataset, split, "train", True, sketches)
    if not test or not train:
        raise HearthError.of(Code.UNKNOWN_ID, f"no sketches in the parts of split `{split}`", file=str(dataset.folder))
    names = [each.execution_id for each in test]
    for model in models:
        refuse_seen(model, dataset, split, names)
    methods = [*_yardsticks(train, test, seed), *_trained(models, beam)]
    if number == "5.4":
        methods = _after(_texts(models, beam, dataset, names), methods)
    elif number == "5.5":
        written = list(demonstrated(models, beam, there, split, names, seed, sketches))
        methods = [*(each for each in methods if each.name == "empty program"), *_after(written, methods)]
    elif number == "5.3":
        methods = [each for each in methods if each.name == "planner" or "(K=" in each.name]
    answers = _answers(dataset, names, methods, sketches, seen)
    groups = _activities(dataset, names)
    rows = scored_rows(dataset, names, groups, _entrants(methods, answers), COLUMNS, seed)
    true = [each.sketch for each in test]
    others = [_other_person(test, every, groups, seed)] if number == "5.4" else []
    return [*_of_thesis(number), *others, *(_with_sketches(row, methods, names, true, groups, seed) for row in rows)]


def _answers(
    dataset: Dataset, names: Sequence[str], methods: Sequence[Method], sketches: str, seen: Seen
) -> list[list[Steps]]:
    """Return the programs of each method, in the order of names; worlds are read once for all."""
    found: list[dict[str, Steps]] = [{} for _ in methods]
    done = 0
    for share in requests(dataset, names, worlds=True, sketches=sketches):
        for answers, method in zip(found, methods, strict=True):
            given = share if method.sketches is None else [_other(each, method.sketches[each.id]) for each in share]
            answers |= dict(zip((each.id for each in share), method.write(given), strict=True))
        done += len(share)
        seen(done, len(names))
    return [[answers[name] for name in names] for answers in found]


def _other(request: Request, sketch: Steps) -> Request:
    return replace(request, sketch=sketch)


def _entrants(methods: Sequence[Method], answers: Sequence[Sequence[Steps]]) -> list[Entrant]:
    """Methods of one name are seeds of one."""
    found: dict[str, tuple[str, list[Sequence[Steps]], list[float]]] = {}
    for method, answer in zip(methods, answers, strict=True):
        _, programs, minutes = found.setdefault(method.name, (method.of, [], []))
        programs.append(answer)
        minutes += [] if method.minutes is None else [method.minutes]
    return [Entrant(name, of, programs, minutes) for name, (of, programs, minutes) in found.items()]


def _activities(dataset: Dataset, names: Sequence[str]) -> list[str]:
    query = "SELECT e.execution_id, p.activity_id FROM executions e JOIN programs p USING (program_id)"
    known = dict(dataset.rows(query)[1])
    return [str(known[name]) for name in names]


def _with_sketches(
    row: Row, methods: Sequence[Method], names: Sequence[str], true: Sequence[Steps], groups: Sequence[str], seed: int
) -> Row:
    """Return a row with the likeness of its sketches to the true ones, where models wrote them."""
    own = [each.sketches for each in methods if each.name == row.method and each.sketches is not None]
    if not own:
        return row
    scores = [score_pairs((sketches[name], one) for name, one in zip(names, true, strict=True)) for sketches in own]
    values: list[float | None] = [sum(each.step for each in seeds) / len(own) for seeds in zip(*scores, strict=True)]
    return row._replace(scores={**row.scores, **by_group({"sketch": values}, groups, seed)})


def _other_person(
    test: Sequence[baselines.Example], every: Sequence[baselines.Example], groups: Sequence[str], seed: int
) -> Row:
    """Return the similarity of two people's sketches for the same text: a bound for the sketches of a model."""
    others = [next((one for one in every if one.text == each.text and one is not each), None) for each in test]
    pairs = [(other.sketch, each.sketch) for each, other in zip(test, others, strict=True) if other]
    scores = iter(score_pairs(pairs))
    values: list[float | None] = [next(scores).step if other else None for other in others]
    return Row("Another person, same text", "yardstick", dict(by_group({"sketch": values}, groups, seed)))


def _of_thesis(number: str) -> Iterator[Row]:
    for each in baselines.THESIS:
        name, _, place = each.baseline.partition(", table ")
        if place == number:
            values = {column: getattr(each, column, None) for column in COLUMNS} | {"lcs": None}
            values["lcs_instances"] = each.step_instances
            yield Row(name, "thesis", {column: value for column, value in values.items() if value is not None})


def _yardsticks(train: Sequence[baselines.Example], test: Sequence[baselines.Example], seed: int) -> Iterator[Method]:
    """Yield the nearest sketch of the original training programs, and the methods without training."""

    def nearest(asked: Sequence[Request]) -> list[Steps]:
        known = {each.execution_id: each for each in test}
        found = [known[each.id]._replace(sketch=each.sketch) for each in asked]
        return baselines.BY_SKETCH["nearest sketch"](train, found, seed, _knowledge(asked))

    yield Method("nearest sketch", "yardstick", nearest)
    for name, start in baselines.BY_START.items():
        yield Method(name, "yardstick", _started(name, start, train, seed))


def _knowledge(asked: Sequence[Request]) -> Any:
    return asked[0].world.home.knowledge if asked and asked[0].world else None


def _started(name: str, start: baselines.Starting, train: Sequence[baselines.Example], seed: int) -> Writer:
    def write(asked: Sequence[Request]) -> list[Steps]:
        given = ((each, each.world) for each in asked if each.world is not None)
        found = []
        for each, world in given:
            one = baselines.Example(each.id, "", (), each.sketch)
            found.append(start(train, one, world, each.rules, rng(seed, name, each.id)))
        return found

    return write


def _trained(models: Sequence[Path | str], beam: int) -> Iterator[Method]:
    """Yield the models of sketches; those that can be decoded without the engine, both ways."""
    for name, trained, minutes in _restored(models):
        if MODELS[name].input == "sketch":
            rounds = getattr(getattr(trained, "settings", None), "rounds", None)
            label = name if rounds is None else f"{name} (K={rounds})"
            yield Method(label, "ours", partial(_predicted, trained, beam), minutes)
            if hasattr(trained, "free"):
                yield Method(f"{label}, free", "ours", partial(_predicted, trained.free(), beam), minutes)


def _restored(models: Sequence[Path | str]) -> Iterator[tuple[str, Any, float | None]]:
    for model in models:
        name, trained = restore(model)
        yield name, trained, trained.checkpoint().trained.get("minutes")


def _predicted(trained: Any, beam: int, asked: Sequence[Request]) -> Sequence[Steps]:
    found: Sequence[Steps] = trained.predict(asked, beam)
    return found


def _texts(
    models: Sequence[Path | str], beam: int, dataset: Dataset, names: Sequence[str]
) -> list[tuple[str, Mapping[str, Steps]]]:
    """Return the models that write sketches, and their sketches by execution."""
    made: list[tuple[str, Mapping[str, Steps]]] = []
    for name, trained, _ in _restored(models):
        if MODELS[name].output == "sketch" and MODELS[name].input == "text":
            written = predict(trained, dataset, names, beam, text=True)
            made.append((name, dict(written)))
    if not made:
        message = "table 5.4 needs a model that writes sketches"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="name a trained `desc2sketch` with --model")
    return made


def _after(texts: Sequence[tuple[str, Mapping[str, Steps]]], methods: Sequence[Method]) -> list[Method]:
    """Return each model after each model of sketches, and the planner, which has the given sketches, too."""
    planner = next(each for each in methods if each.name == "planner")
    writers = [planner, *(each for each in methods if each.of == "ours")]
    made = [planner._replace(name="planner, given sketches")]
    for name, written in texts:
        of = "ours" if name in MODELS else "yardstick"
        made += [each._replace(name=f"{name}, {each.name}", of=of, sketches=written) for each in writers]
    return made
