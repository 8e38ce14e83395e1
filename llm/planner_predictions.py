"""Predictions of a language model for a part of a dataset, in the file that `score dataset` reads."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.llm.embeddings import vectors_of
from hearth.llm.endpoint import Endpoint
from hearth.llm.language_planner import MOST_SHOTS, LanguagePlanner
from hearth.llm.language_settings import Means
from hearth.models.interface import Steps
from hearth.models.prediction_files import completed, names_asked, write
from hearth.models.text.mixed_similarity import MixedSimilarity, chosen_weight
from hearth.models.text.retrieval import Similarity
from hearth.models.text_examples import Example, corpus, examples, requests
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
    embed: str = "",
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
        embed: `llm:MODEL@URL` or a folder with weights, whose vectors choose examples, as words do; validation examples
            choose the weight of each.
        seen: reports progress.

    Raises:
        HearthError: no such dataset, split or part; BAD_ARGUMENT: examples without a split, or too many; vectors and no
            examples; the server obeys no grammar; those of `vectors_of`.
    """
    if not 0 <= shots <= MOST_SHOTS or (shots and not split):
        message = f"{shots} examples of the split `{split}`"
        raise HearthError.of(
            Code.BAD_ARGUMENT, message, suggestion=f"0 to {MOST_SHOTS}, of a split with training programs"
        )
    if embed and not shots:
        message = "vectors choose examples, and none are asked for"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="--shots 8")
    dataset = Dataset.open(folder)
    names = names_asked(dataset, split, part, originals)[:limit]
    known: Sequence[Example] = examples(dataset, split, "train", originals=True) if shots else ()
    similarity, weighed = _similarity(dataset, split, embed, endpoint.means) if embed else (Similarity, {})
    planner = LanguagePlanner(endpoint, dataset.knowledge, known, shots, similarity)
    found = _predicted(planner, dataset, names, seen)
    count = write(completed(dataset, found) if repaired else found, out)
    facts = {"prompt": planner.page.name, "prompt_fingerprint": planner.page.fingerprint, "shots": shots, **weighed}
    spent = planner.planned.as_json()
    cost = endpoint.means.cost(spent["tokens_in"], spent["tokens_out"])
    first = planner.planned.first
    why = {} if first is None else {"first_unanswered": first.message}
    return {"predictions": count, "executions": len(names), **facts, **spent, "cost": round(cost, 6), **why}


def _similarity(dataset: Dataset, split: str, embed: str, means: Means) -> tuple[Any, dict[str, Any]]:
    """Return what makes similarities by words and vectors, with the weight that validation chooses, and the facts."""
    vectors, given = vectors_of(embed, means), corpus(dataset, split)
    weight = chosen_weight(given.train, given.checked(), vectors)
    return partial(MixedSimilarity, vectors=vectors, weight=weight), {"embed": embed, "embed_weight": weight}


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
