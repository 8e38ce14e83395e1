"""Predictions of a language model for a part of a dataset, in the file that `score dataset` reads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.llm.endpoint import Endpoint
from hearth.llm.language_planner import MOST_SHOTS, LanguagePlanner
from hearth.models.interface import Steps
from hearth.models.prediction_files import completed, names_asked, write
from hearth.models.text_examples import Example, examples, requests
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.parallel import Seen, unseen


def predict_part(
    endpoint: Endpoint,
    folder: Path,
    out: Path,
    split: str,
    part: str,
    *,
    shots: int = 0,
    repaired: bool = False,
    originals: bool = False,
    limit: int | None = None,
    seen: Seen = unseen,
) -> dict[str, Any]:
    """Write the programs that a language model predicts for a part of a dataset, and return the counts.

    Replies are kept in the endpoint's cache: the same call after a stop asks nothing twice. Executions whose text has
    no answer are not in the file, and are counted.

    Args:
        endpoint: the model; its `asking.constrained` sends the grammar of steps.
        folder: of the dataset.
        out: the file to write.
        split, part: of the dataset; `part` is a prefix.
        shots: examples before each request, of the split's training part.
        repaired: bind and repair each program in its environment, and leave out the steps that can't run there.
        originals: leave out executions of augmented programs.
        limit: the first executions only.
        seen: reports progress.

    Raises:
        HearthError: no such dataset, split or part; BAD_ARGUMENT: examples without a split, or too many; the server
            obeys no grammar.
    """
    if not 0 <= shots <= MOST_SHOTS or (shots and not split):
        message = f"{shots} examples of the split `{split}`"
        raise HearthError.of(
            Code.BAD_ARGUMENT, message, suggestion=f"0 to {MOST_SHOTS}, of a split with training programs"
        )
    dataset = Dataset.open(folder)
    names = names_asked(dataset, split, part, originals)[:limit]
    known: Sequence[Example] = examples(dataset, split, "train", originals=True) if shots else ()
    planner = LanguagePlanner(endpoint, dataset.knowledge, known, shots)
    found = _predicted(planner, dataset, names, seen)
    count = write(completed(dataset, found) if repaired else found, out)
    facts = {"prompt": planner.page.name, "prompt_fingerprint": planner.page.fingerprint, "shots": shots}
    spent = planner.planned.as_json()
    cost = endpoint.means.cost(spent["tokens_in"], spent["tokens_out"])
    first = planner.planned.first
    why = {} if first is None else {"first_unanswered": first.message}
    return {"predictions": count, "executions": len(names), **facts, **spent, "cost": round(cost, 6), **why}


def _predicted(
    planner: LanguagePlanner, dataset: Dataset, names: Sequence[str], seen: Seen
) -> Iterator[tuple[str, Steps]]:
    """Yield the executions whose text has an answer; each text is asked once."""
    known: dict[tuple[str, str], Steps | None] = {}
    done = 0
    for share in requests(dataset, names, worlds=False):
        step = planner.at_once * 4
        for first in range(0, len(share), step):
            some = share[first : first + step]
            new = {(each.title, each.description): each for each in some if (each.title, each.description) not in known}
            known |= dict(zip(new, planner.predict(list(new.values())), strict=True))
            for each in some:
                steps = known[each.title, each.description]
                if steps is not None:
                    yield each.id, steps
            done += len(some)
            seen(done, len(names))
