"""Prediction files: a program for each execution of a part of a dataset, in the form that `score dataset` reads."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from pathlib import Path

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.sketch_choice import ANNOTATED
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.decoding.scorers import Scorer
from hearth.models.decoding.search import Search, Start, decode
from hearth.models.interface import Steps
from hearth.models.model_registry import MODELS, restore
from hearth.models.protocols import Decoded, Trained
from hearth.models.text_examples import AT_ONCE, requests
from hearth.models.training_overlap import refuse_seen
from hearth.repair.runnable_predictions import complete
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import Program
from hearth.schemas.syntax import print_lines
from hearth.scoring.dataset_scores import chosen
from hearth.simulation.rules import RULES
from hearth.storage import chosen_files
from hearth.storage.parallel import Seen, unseen


def predict(
    trained: Trained,
    dataset: Dataset,
    names: Sequence[str],
    beam: int = 1,
    *,
    text: bool,
    sketches: str = ANNOTATED,
    seen: Seen = unseen,
) -> Iterator[tuple[str, Steps]]:
    """Yield the ids of executions with their predicted programs, in the dataset's order.

    Args:
        trained: a trained model.
        dataset: a published dataset.
        names: ids of executions.
        beam: as in `Trained.predict`.
        text: the model sees the text alone: each text is answered once, and no worlds are read.
        sketches: `annotated` or `inferred`: which go before the others.
        seen: reports progress.
    """
    known: dict[tuple[str, str], Steps] = {}
    done = 0
    for share in requests(dataset, names, worlds=not text, sketches=sketches):
        if text:
            asked = {(each.title, each.description): each for each in share}
            new = {key: replace(each, sketch=()) for key, each in asked.items() if key not in known}
            known |= dict(zip(new, trained.predict(list(new.values()), beam), strict=True))
            answers = [known[each.title, each.description] for each in share]
        else:
            answers = trained.predict(share, beam)
        yield from ((each.id, steps) for each, steps in zip(share, answers, strict=True))
        done += len(share)
        seen(done, len(names))


def constrained(
    trained: Trained,
    dataset: Dataset,
    names: Sequence[str],
    beam: int = 1,
    sketches: str = ANNOTATED,
    seen: Seen = unseen,
) -> Iterator[tuple[str, Steps]]:
    """Predict with the engine in the loop: each program parses, and runs in its environment.

    Raises:
        HearthError: BAD_ARGUMENT, if the model can't be decoded so.
    """
    scorer = scorer_of(trained)
    done = 0
    for share in requests(dataset, names, worlds=True, sketches=sketches):
        for first in range(0, len(share), WRITTEN):
            part = share[first : first + WRITTEN]
            starts = [Start(each.world, each, rules=each.rules) for each in part if each.world]
            yield from zip((each.id for each in part), decode(scorer, starts, Search(beam=beam)), strict=True)
        done += len(share)
        seen(done, len(names))


WRITTEN = 32
"""Programs that are decoded at once."""


def scorer_of(trained: Trained) -> Scorer:
    """Return a model as decoding sees it.

    Raises:
        HearthError: BAD_ARGUMENT, if it can't be decoded with the engine in the loop.
    """
    if isinstance(trained, Decoded):
        return trained.scorer()
    message = "this model does not write step by step, and can't be decoded with the engine in the loop"
    raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="use --repair")


def write(predicted: Iterator[tuple[str, Steps]], path: Path) -> int:
    """Write a file of predictions, a JSON object a line; their number."""
    rows = [{"id": name, "predicted": list(print_lines(Program(steps=steps)))} for name, steps in predicted]
    chosen_files.write_rows(path, rows)
    return len(rows)


def predict_part(
    model: str,
    folder: Path,
    out: Path,
    split: str,
    part: str,
    *,
    beam: int = 1,
    repaired: bool = False,
    is_constrained: bool = False,
    originals: bool = False,
    sketches: str = ANNOTATED,
    limit: int | None = None,
    seen: Seen = unseen,
) -> int:
    """Write the predictions of a trained model for a part of a split; their number.

    Args:
        model: a checkpoint's folder, or the name of one that comes with Hearth.
        folder: of the dataset.
        out: the file to write.
        split, part: of the dataset; `part` is a prefix.
        beam: as in `Trained.predict`.
        repaired: bind and repair each program in its environment, and leave out the steps that can't run there.
        is_constrained: decode with the engine in the loop; models of sketches always do.
        originals: leave out executions of augmented programs.
        sketches: `annotated` or `inferred`: which go before the others.
        limit: the first executions only.
        seen: reports progress.

    Raises:
        HearthError: no such checkpoint, dataset, split or part; BAD_ARGUMENT, if the model was trained by another split
            on programs of the part, which is not of training.
    """
    dataset = Dataset.open(folder)
    name, trained = restore(model)
    names = names_asked(dataset, split, part, originals)[:limit]
    if split and not part.startswith("train"):
        refuse_seen(model, dataset, split, names)
    text = MODELS[name].input == "text"
    if is_constrained and text:  # models of sketches do so by themselves
        found = constrained(trained, dataset, names, beam, sketches, seen)
    else:
        found = predict(trained, dataset, names, beam, text=text, sketches=sketches, seen=seen)
    return write(completed(dataset, found) if repaired else found, out)


def names_asked(dataset: Dataset, split: str, part: str, originals: bool) -> list[str]:
    """Return the ids of the executions of a part; without those of augmented programs if `originals`."""
    names = chosen(dataset, split, part)
    if originals:
        query = "SELECT execution_id FROM executions JOIN programs USING (program_id) WHERE parent_id IS NULL"
        own = {name for (name,) in dataset.rows(query)[1]}
        names = [name for name in names if name in own]
    return names


def completed(dataset: Dataset, predicted: Iterable[tuple[str, Steps]]) -> Iterator[tuple[str, Steps]]:
    """Predictions bound and repaired in the environments of their executions."""
    homes = opened(str(dataset.folder))[1]
    found = iter(predicted)
    while share := dict(islice(found, AT_ONCE)):
        for case in stored_cases(dataset, list(share)):
            world = start_of(case["environment"], case["home"], homes)
            done = complete(share[case["execution_id"]], world, world.home.knowledge, RULES[case["rules"]])
            yield case["execution_id"], done.execution.program.steps
