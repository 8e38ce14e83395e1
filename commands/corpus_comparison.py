"""`corpus realism`, `corpus agreement` and `corpus retrieval`: corpora and annotations compared with others."""

from pathlib import Path
from typing import Any

import typer

from hearth.commands import inputs, output


def realism(
    sources: list[Path] | None = None,
    against: list[Path] | None = None,
    draws: int = 20,
    halves: str = "programs",
    shared: bool = False,
    out: Path | None = None,
    kb: Path | None = None,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Compare a corpus with another, such as people's: this one and half of the other predict the other half.

    The other corpus is split into two halves; as many programs of this one are drawn as a half has. Both, the draw and
    the first half, are asked about the second half: perplexity of its steps, instructions never seen, divergence of
    actions, objects, lengths and words. A ratio of 1: the draw knows as much as people's own programs.

    \b
    Examples:
      hearth corpus realism --against release.zip
      hearth corpus realism mine.csv --against release.zip --halves activities --out figures
    """
    from hearth.analysis import corpus_realism as numbers
    from hearth.analysis.corpus_statistics import gather

    if halves not in ("programs", "activities"):
        raise typer.BadParameter("`programs` or `activities`", param_hint="--halves")
    if not against:
        raise typer.BadParameter("the corpus to compare with is missing", param_hint="--against")
    known = inputs.read_knowledge(kb)
    ours, theirs = (numbers.programs(gather(inputs.paths(paths), known)) for paths in (sources, against))
    drawn = numbers.of_activities(ours, theirs) if shared else ours
    found = numbers.compare(drawn, theirs, seed, draws, by_activity=halves == "activities")
    portraits = {"ours": numbers.portrait(ours), "theirs": numbers.portrait(theirs)}
    files: list[Path] = []
    if out is not None:
        from hearth.analysis.corpus_realism_figure import draw

        files = draw(ours, theirs, found, out)
    if as_json:
        output.emit({
            "measures": found, "portraits": portraits, "draws": draws, "halves": halves, "shared_activities": shared,
            "programs_drawn_from": len(drawn), "smoothing": numbers.SMOOTHING, "files": files,
        })  # fmt: skip
        return
    _print_realism(found, portraits, files)
    output.line(f"{draws} draws from {len(drawn):,} programs; halves by {halves}; {numbers.SMOOTHING}.")


def _print_realism(found: dict[str, Any], portraits: dict[str, dict[str, Any]], files: list[Path]) -> None:
    rows = [
        (name, *(_interval(kinds.get(kind)) for kind in ("ours", "theirs", "ratio"))) for name, kinds in found.items()
    ]
    output.table(("asked about the second half", "ours", "theirs", "ratio"), rows)
    output.line()
    names = portraits["ours"]
    output.table(("corpus", *portraits), [(name, *(one[name] for one in portraits.values())) for name in names])
    for file in files:
        output.line(f"Drawn: {file}")


def _interval(found: dict[str, float] | None) -> str:
    return f"{found['mean']:.3f} ({found['low']:.3f} to {found['high']:.3f})" if found else "-"


def agreement(first: Path, second: Path, as_json: bool = False) -> None:
    """Compare two files of annotated sketches of the same programs: F1, Cohen's kappa, and equal sketches.

    Given one file twice, its repeated annotations of one program are compared.

    \b
    Example:
      hearth corpus agreement sketches.json sketches_second.json
    """
    from hearth.analysis.sketch_agreement import compare

    found = compare(first, second)
    output.emit(found) if as_json else output.figures(found)


def retrieval(
    sources: list[Path] | None = None,
    kb: Path | None = None,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Retrieve the program of the most similar description, trained on the corpus before and after its second part.

    Both are tested on the same programs: those of a fifth of the first part's activities, or those of other sources.
    Not trained on are programs of these activities, and those with nearly the same words or steps as a test. Scores are
    normalised LCS of actions, objects and steps.

    \b
    Examples:
      hearth corpus retrieval
      hearth corpus retrieval release.zip
    """
    from hearth.analysis import corpus_retrieval as study

    tested = inputs.paths(sources) if sources else None
    found = study.before_and_after(inputs.read_knowledge(kb), seed, tested)
    if as_json:
        output.emit(found)
        return
    rows = [(name, one["programs"], *(_interval(one["scores"][score]) for score in study.SCORES)) for name, one in
            found["trained_on"].items()]  # fmt: skip
    output.table(("trained on", "programs", *study.SCORES), rows)
    output.line(f"{found['tested']} held-out descriptions of {found['activities']} activities.")
