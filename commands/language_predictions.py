"""`model predict llm:NAME`: the predictions of a language model, and their cost."""

from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands import output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.llm.endpoint import Endpoint


def predict(
    model: "Endpoint",
    dataset: Path,
    out: Path,
    split: str,
    part: str,
    shots: int,
    repair: bool,
    originals: bool,
    limit: int | None,
    embed: str,
    as_json: bool,
) -> None:
    """Write predictions, and print the counts; the status is 1 if texts have no answer."""
    from hearth.commands.progress_line import bar
    from hearth.llm.planner_predictions import predict_part

    with bar("executions", model.spending) as seen:
        facts = predict_part(
            model, dataset, out, split, part,
            shots=shots, repaired=repair, originals=originals, limit=limit, embed=embed, seen=seen,
        )  # fmt: skip
    if as_json:
        output.emit({"out": out, **facts})
    else:
        shown = {name: value for name, value in facts.items() if not isinstance(value, dict)}
        counted = [(name, facts[name]) for name in ("faults", "warnings", "unanswered")]
        counts = {f"{name} {code}": number for name, codes in counted for code, number in codes.items()}
        output.figures({"out": out, **shown, **counts})
    output.status(sum(facts["unanswered"].values()), strict=True)


def refuse_options(*, given: bool) -> None:
    """Refuse options of language models for another model.

    Raises:
        HearthError: BAD_ARGUMENT: some are given.
    """
    if given:
        message = "--shots, --embed, --llm, --cache, --prices and --budget are about language models"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="hearth model predict llm:MODEL@URL ...")


def retrieval(
    dataset: Path,
    *,
    embed: str,
    split: str = "activities",
    limit: int | None = None,
    cache: Path | None = None,
    as_json: bool = False,
) -> None:
    """Compare ways to find the most similar training text: by words, by vectors, and by both (table 4.5's LCS).

    --embed is a folder with weights, or llm:MODEL@URL, whose server answers /v1/embeddings. Validation examples choose
    the weight of both; the tests are original programs.

    \b
    Examples:
      hearth model retrieval data_out --embed all-MiniLM-L6-v2
      hearth model retrieval data_out --embed llm:nomic-embed-text@http://127.0.0.1:11434/v1 --limit 200
    """
    from hearth.analysis.retrieval_by_vectors import compared
    from hearth.llm.embeddings import vectors_of
    from hearth.llm.language_settings import Means

    rows = compared(dataset, split, vectors_of(embed, Means(cache=cache)), limit)
    if as_json:
        output.emit({"embed": embed, "rows": rows})
    else:
        output.records(rows)
