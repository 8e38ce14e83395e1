"""`model predict llm:NAME`: the predictions of a language model, and their cost."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from hearth.commands import output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.llm.endpoint import Endpoint


def asked_model(
    name: str,
    out: Path,
    llm: Sequence[str] | None,
    cache: Path | None,
    prices: str,
    budget: float | None,
    constrained: bool,
) -> "Endpoint":
    """Return the language model of a command line; errors as of `read_settings` and `Endpoint`."""
    from hearth.llm.endpoint import endpoint_of
    from hearth.llm.language_settings import kept_next_to, read_settings

    asking, means = read_settings(llm or (), cache or kept_next_to(out, (name,)), prices, budget)
    if asking.images:
        message = "planners and judges read texts, and are shown no pictures"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="leave out images")
    return endpoint_of(name, replace(asking, constrained=asking.constrained or constrained), means)


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


def refuse_options(
    shots: int, embed: str, llm: Sequence[str] | None, cache: Path | None, prices: str, budget: float | None
) -> None:
    """Refuse options of language models for another model.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    if shots or embed or llm or cache or prices or budget is not None:
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
