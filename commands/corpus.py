"""`corpus`: statistics, synthesis, ratings and error detection of descriptions and programs."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from hearth.commands import corpus_comparison, inputs, output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.terminal import shown_line

if TYPE_CHECKING:
    from collections.abc import Iterable

    from hearth.analysis.corpus_statistics import Corpus, Similarities
    from hearth.schemas.program import Program

app = typer.Typer(help="Descriptions and programs: statistics, comparison, synthesis, ratings and error detection.")
for _comparison in (corpus_comparison.realism, corpus_comparison.agreement, corpus_comparison.retrieval):
    app.command()(_comparison)


@app.command()
def template(out: Path | None = None, as_json: bool = False) -> None:
    """Write a table to fill in, with a program a row, that `build` reads.

    \b
    Example:
      hearth corpus template --out mine.csv
    """
    from importlib.resources import files

    from hearth.storage.chosen_files import write

    text = (files("hearth.data_raw") / "template.csv").read_text("utf-8")
    if out is not None:
        write(out, text.encode())
    if out is None or as_json:
        output.say(text.rstrip("\n"), {"out": out, "template": text}, as_json)


@app.command()
def synthesize(
    count: int = 5_193,
    seed: int = 0,
    actions: str = "animated",
    descriptions: int = 2,
    grammar: Path | None = None,
    described: bool = False,
    splits: Path | None = None,
    out: Path | None = None,
    kb: Path | None = None,
    as_json: bool = False,
) -> None:
    """Draw distinct programs with descriptions from a probabilistic grammar, as JSON Lines that `build` reads.

    Programs have one to three tasks of the grammar. Each says in which part it is of splits that hold out paraphrases,
    tasks, pairs of tasks, or objects: a build publishes them among its splits. With --splits a table has the parts of
    all descriptions; --json then has their sizes. It also has the mean LCS of an ideal reader, who understands all that
    is said and knows how likely the rest is. With --described: the programs, drawn once, whose descriptions were
    written one by one.

    \b
    Examples:
      hearth corpus synthesize --out synthetic.jsonl
      hearth corpus synthesize --out synthetic.jsonl --splits splits.csv --json
      hearth corpus synthesize --described --out described.jsonl
      hearth corpus synthesize 20000 --seed 7 --actions all --out more.jsonl
      hearth sample synthetic.jsonl   (runs each of them in every home)
    """
    import orjson

    from hearth.analysis import description_information, synthesis
    from hearth.analysis import synthesis_splits as numbers
    from hearth.analysis import written_descriptions as written
    from hearth.storage.chosen_files import writing

    if actions not in ("animated", "all"):
        raise typer.BadParameter("`animated` or `all`", param_hint="--actions")
    figures: dict[str, Any] = {"programs": count}
    if described and splits:
        raise typer.BadParameter("not with --described", param_hint="--splits")
    if described:
        records: Iterable[dict[str, Any]] = tuple(written.described())
        count = figures["programs"] = sum(1 for _ in records)
    else:
        weights = synthesis.load(grammar or synthesis.FILE, inputs.read_knowledge(kb), every_action=actions == "all")
        drawn = list(synthesis.synthesize(count, seed, weights, descriptions))
        rows = numbers.splits(drawn, seed)
        if splits:
            numbers.write(rows, seed, splits)
        figures, parts = numbers.figures(drawn, rows if splits else ()), numbers.of_first(rows)
        if as_json and out is not None:
            figures["ideal_reader"] = description_information.figures(drawn, rows, weights)
        records = (synthesis.record(one, number, seed, parts[number]) for number, one in enumerate(drawn, 1))
    lines = (shown_line(orjson.dumps(record)) + b"\n" for record in records)
    if out is None:
        sys.stdout.buffer.writelines(lines)
        return
    with writing(out) as temporary, temporary.open("wb") as file:
        file.writelines(lines)
    output.say(f"{output.counted(count, 'program')} in {out}", {**figures, "seed": seed, "file": out}, as_json)


@app.command()
def stats(
    sources: list[Path] | None = None,
    out: Path | None = None,
    kb: Path | None = None,
    as_json: bool = False,
) -> None:
    """Print statistics of a corpus next to the thesis's: funnel, variety, diversity, averages, missing actions.

    With --out: histograms of actions and objects, the funnel, the similarity matrix of activities and the
    co-occurrence of objects as PNG and SVG, and all numbers as Parquet.

    \b
    Examples:
      hearth corpus stats data_out --out figures
      hearth corpus stats release.zip
    """
    from hearth.analysis import corpus_figures
    from hearth.analysis import corpus_statistics as numbers

    found = numbers.gather(inputs.paths(sources), inputs.read_knowledge(kb))
    alike = numbers.similarities(found)
    files = corpus_figures.write(found, alike, out) if out else []
    if as_json:
        output.emit(_stats_json(found, alike, files))
    else:
        _print_stats(found, alike)
        for file in files:
            output.line(file)


def _stats_json(found: Corpus, alike: Similarities, files: list[Path]) -> dict[str, Any]:
    from hearth.analysis import corpus_statistics as numbers

    actions, objects = numbers.frequencies(found)
    return {
        "funnel": numbers.funnel(found),
        "variety": numbers.variety(found),
        "averages": dict(zip(("programs", "steps", "sentences", "words"), numbers.averages(found), strict=True)),
        **{name: dict(getattr(found, name).most_common()) for name in ("refused", "warnings", "specials")},
        "actions": dict(actions.most_common()),
        "objects": dict(objects.most_common()),
        "activities": [
            {"title": one.title, "programs": one.programs, "lcs": one.lcs, "normalised": one.normalised}
            for one in alike.activities
        ],
        "files": files,
    }


def _print_stats(found: Corpus, alike: Similarities) -> None:
    from hearth.analysis import corpus_statistics as numbers

    for title, ours, thesis in (
        ("What became of the descriptions", numbers.funnel(found), numbers.THESIS_FUNNEL),
        ("Variety", numbers.variety(found), numbers.THESIS_VARIETY),
    ):
        _print(title, ("", "here", "thesis 3.4"), [(name, ours[name], theirs) for name, theirs in thesis.items()])
    table = [("here", *numbers.averages(found)), *((name, *row) for name, row in numbers.THESIS_AVERAGES.items())]
    _print("Averages (table 4.1)", ("dataset", "programs", "steps", "sentences", "words"), table)
    compared = [
        (title, *((own.programs, own.lcs, own.normalised) if own else (0, None, None)), *row)
        for title, row, own in numbers.beside_thesis(alike.activities)
    ]
    columns = ("activity", "programs", "LCS", "norm. LCS", "thesis: programs", "LCS", "norm. LCS")
    _print("Diversity of programs (table 3.1)", columns, compared)
    common = [(one.title, one.programs, one.lcs, one.normalised) for one in alike.activities[:8] if one.programs > 1]
    _print("The commonest activities", ("activity", "programs", "LCS", "norm. LCS"), common)
    for title, counts in (("Refused", found.refused), ("Warnings", found.warnings), ("Special blocks", found.specials)):
        if counts:
            _print(title, ("", "times"), [*counts.most_common(12)])


@app.command()
def dirt(key: Path, sources: list[Path] | None = None, kb: Path | None = None, as_json: bool = False) -> None:
    """Measure the error detection in a corpus whose faults are known: precision and recall.

    \b
    Example:
      hearth corpus dirt data_raw/crowd/key.csv
    """
    from hearth.analysis import error_detection as finding

    report = finding.score(finding.find(inputs.paths(sources), inputs.read_knowledge(kb)), finding.read_key(key))
    if as_json:
        output.emit(report)
        return
    rows = [(one.fault, one.labelled, one.found, one.recall, _codes(one.codes)) for one in report.scores]
    _print("Found, by kind of fault", ("fault", "labelled", "found", "recall", "as (! refused)"), rows)
    _print("Found in records that are not in the key", ("as", "records"), [*report.false])
    total = [("all findings", report.precision, report.recall), ("refusals", report.rejected_precision, None)]
    _print("Altogether", ("", "precision", "recall"), total)


def _codes(codes: tuple[tuple[str, int], ...]) -> str:
    return ", ".join(f"{code} {count}" for code, count in codes)


@app.command()
def fuzz(seconds: float = 300, seed: int = 0, most: int | None = None, as_json: bool = False) -> None:
    """Test every reader with mutated input; the status is 1 if a record caused a traceback or was lost.

    Prints a line for each reader: files, files refused whole, and the records of the others by outcome.

    \b
    Example:
      hearth corpus fuzz --seconds 60 --seed 7
    """
    report = _mutated_input().fuzz(inputs.read_knowledge(None), seconds, seed, most)
    if as_json:
        output.emit(report)
    else:
        columns = ("reader", "files", "refused whole", "records", "accepted", "rejected", "silently lost",
                   "tracebacks", "longest (ms)")  # fmt: skip
        rows = [
            (one.reader, one.inputs, one.refused_whole, one.records, one.accepted, one.rejected, one.silent,
             one.tracebacks, round(1000 * one.longest, 1))
            for one in report.table()
        ]  # fmt: skip
        _print("Mutated input by reader", columns, rows)
        _print("Reasons of refusals", ("code", "times"), [*report.codes.most_common()])
        for crash in report.crashes[:20]:
            output.line(crash)
    output.status(sum(not one.adds_up or one.tracebacks for one in report.table()), strict=True)


def _mutated_input() -> Any:
    """Return the module of the tests that mutates input; an installed package is without it."""
    tests = Path(__file__).resolve().parents[1] / "tests"
    if not tests.is_dir():
        raise HearthError.of(Code.MISSING_FILE, "mutated input belongs to the tests", suggestion="run it in a checkout")
    sys.path.append(str(tests))
    return importlib.import_module("oracles.mutated_input")


@app.command()
def sheet(
    sources: list[Path] | None = None,
    count: int = 100,
    raters: int = 5,
    seed: int = 0,
    out: Path | None = None,
    as_json: bool = False,
) -> None:
    """Write a sheet on which people rate the completeness of programs (thesis 3.4.1).

    \b
    Example:
      hearth corpus sheet data_out --programs 100 --out ratings.csv
    """
    from hearth.analysis import completeness_ratings
    from hearth.storage.chosen_files import write

    drawn = _drawn(sources, count, seed)
    text = completeness_ratings.sheet(drawn, raters)
    if out is not None:
        write(out, text.encode())
    message = text.removesuffix("\n") if out is None else f"{out}: ratings are 1, 2 or 3"
    output.say(message, {"programs": [name for name, _ in drawn], "raters": raters, "file": out}, as_json)


def _drawn(sources: list[Path] | None, count: int, seed: int) -> list[tuple[str, Program]]:
    """Return some valid programs, the same for the same seed."""
    from hearth.analysis import corpus_statistics as numbers
    from hearth.schemas.program import Program
    from hearth.schemas.rng import rng

    found = numbers.gather(inputs.paths(sources), inputs.read_knowledge(None))
    chosen = rng(seed, "ratings").sample(found.programs, min(count, len(found.programs)))
    return [(p.program_id, Program(p.title, found.descriptions.get(p.description_id, ""), p.steps)) for p in chosen]


@app.command()
def completeness(
    sources: list[Path] | None = None,
    sheets: list[Path] | None = None,
    count: int = 100,
    home: str = "maple",
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Estimate how complete programs are by the steps that repairs insert, next to raters and the thesis's 64/28/8%.

    \b
    Examples:
      hearth corpus completeness data_out --programs 100
      hearth corpus completeness data_out --programs 100 --sheet ratings.csv
    """
    from hearth.analysis import completeness_ratings

    known = inputs.read_knowledge(None)
    place = inputs.read_home(home, None, None, known)
    guessed = {
        name: completeness_ratings.estimate(one, place, known, seed) for name, one in _drawn(sources, count, seed)
    }
    estimated = {name: found for name, found in guessed.items() if not isinstance(found, Failure)}
    rated = completeness_ratings.medians(completeness_ratings.read_sheets(sheets or []))
    table = [
        ("thesis 3.4.1", 100, *completeness_ratings.THESIS.values()),
        ("estimated", len(estimated), *_shares(estimated)),
    ]
    if rated:
        table.append(("rated", len(rated), *_shares(rated)))
    agree = completeness_ratings.agreement(estimated, rated) if rated else None
    if as_json:
        output.emit({"rows": table, "agreement": agree, "estimates": {k: int(v) for k, v in estimated.items()}})
        return
    _print("Completeness of programs", ("", "programs", *completeness_ratings.SAID.values()), table)
    if agree is not None:
        output.line(f"Estimate and median agree on {agree:.0%} of the programs that have both.")


def _shares(classes: dict[str, Any]) -> list[float]:
    from hearth.analysis import completeness_ratings

    return [*completeness_ratings.shares(classes.values()).values()]


def _print(title: str, columns: tuple[str, ...], rows: list[tuple[Any, ...]]) -> None:
    output.table(columns, rows, title)
    output.line()
