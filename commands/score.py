"""`score`: compares predicted programs with their references."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from hearth.commands import inputs, options, output

if TYPE_CHECKING:
    from hearth.scoring.bootstrap import Interval
    from hearth.scoring.evaluate import Options, Scored, Summary
    from hearth.scoring.metrics.lcs import LcsScore
    from hearth.scoring.predictions import Pair

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Score predicted programs against references.",
)


File = Annotated[Path, typer.Argument(metavar="FILE", help="Predictions: JSON Lines or Parquet, one row for each id.")]
References = Annotated[
    Path | None, typer.Option("--references", metavar="FILE", help="Rows of id and reference, if FILE has none.")
]
Instances = Annotated[bool, typer.Option("--instances", help="Distinguish the instances of a class.")]
Seed = Annotated[int, typer.Option("--seed", help="Seed of the 95% confidence intervals.")]
By = Annotated[str | None, typer.Option("--by", metavar="FIELD", help="Also the means by a field of the rows.")]
Rules = Annotated[
    Literal["default", "replay"], typer.Option("--rules", help="`replay` reads actions as the release did.")
]
Match = Annotated[
    Literal["none", "swap1", "best"], typer.Option("--match", help="How instances of a class may stand for each other.")
]
Scope = Annotated[
    Literal["either", "own"], typer.Option("--scope", help="Tuples about the objects of either program, or its own.")
]


@app.command("lcs")
def lcs(
    file: File,
    *,
    references: References = None,
    instances: Instances = False,
    seed: Seed = 0,
    as_json: options.Json = False,
) -> None:
    """Longest common subsequence over the longer program's length, by step, by action and by object, and their mean.

    Each row of FILE is {"id": ..., "predicted": PROGRAM, "reference": PROGRAM}; a program is a text or a list of steps.
    A prediction is missing and scores 0 if it is null or if only the references have its id.

    \b
    Example:
      echo '{"id": "tv", "predicted": ["[Walk] <sofa> (1)"], "reference": ["[Sit] <sofa> (1)"]}' > mine.jsonl
      python cli.py score lcs mine.jsonl
    """
    from hearth.scoring.bootstrap import intervals
    from hearth.scoring.evaluate import lcs_of
    from hearth.scoring.metrics.lcs import LEVELS, lcs_signature
    from hearth.scoring.predictions import read_pairs

    pairs = read_pairs(file, references)
    scores = lcs_of(pairs, instances)
    columns = {name: [getattr(score, name) for score in scores] for name in (*LEVELS, "mean")}
    means = intervals(columns, seed)
    signature = lcs_signature("+".join(LEVELS), instances)
    if as_json:
        output.emit(_lcs_json(pairs, scores, means, signature))
    else:
        _print_lcs(pairs, scores, means, signature)


def _lcs_json(
    pairs: Sequence[Pair], scores: Sequence[LcsScore], means: dict[str, Interval], signature: str
) -> dict[str, Any]:
    rows = [
        {"id": pair.id, **score._asdict(), "mean": score.mean, "missing": pair.predicted is None}
        for pair, score in zip(pairs, scores, strict=True)
    ]
    return {"signature": signature, **_counts(pairs), "mean": means, "scores": rows}


def _print_lcs(pairs: Sequence[Pair], scores: Sequence[LcsScore], means: dict[str, Interval], signature: str) -> None:
    named = zip(pairs, scores, strict=True)
    rows: list[list[Any]] = [[pair.id, *score, score.mean, _note(pair)] for pair, score in named]
    rows.append(["mean", *(found.mean for found in means.values()), ""])
    rows.append(["95% from", *(found.low for found in means.values()), ""])
    rows.append(["to", *(found.high for found in means.values()), ""])
    output.table(["id", *means, ""], rows)
    counts = _counts(pairs)
    found = f"{output.counted(counts['count'], 'prediction')}, {counts['missing']} missing, {counts['empty']} empty"
    print(f"\n{found}; {signature}")


def _note(pair: Pair) -> str:
    if pair.predicted is None:
        return "missing"
    return "" if pair.predicted else "empty"


def _counts(pairs: Sequence[Pair]) -> dict[str, int]:
    missing = sum(pair.predicted is None for pair in pairs)
    return {"count": len(pairs), "missing": missing, "empty": sum(pair.predicted == () for pair in pairs)}


@app.command("program")
def program(
    file: File,
    *,
    references: References = None,
    graph: Annotated[
        Path | None, typer.Option("--graph", metavar="FILE", help="The environment of rows without one.")
    ] = None,
    homes: options.Homes = None,
    rules: Rules = "default",
    match: Match = "best",
    scope: Scope = "either",
    instances: Instances = False,
    seed: Seed = 0,
    by: By = None,
    as_json: options.Json = False,
) -> None:
    """All scores: LCS and parsability; for rows with an environment also executability, final-graph F1 and goal.

    Rows are those of `score lcs`. The environment is a row's `graph` (a scene graph's file, relative to FILE's folder)
    or `home` (a name), or else --graph. The goal is what the reference achieves there. Steps may be natural language.

    \b
    Example:
      python cli.py score program predictions.jsonl --graph home.json --by activity
    """
    from functools import partial

    from hearth.scoring import environments
    from hearth.scoring.dataset_scores import read_line
    from hearth.scoring.evaluate import Options, evaluate
    from hearth.scoring.predictions import read_pairs
    from hearth.simulation.rules import RULES

    how = Options(RULES[rules], match, scope, instances, seed)
    known = inputs.read_knowledge(None)
    pairs = read_pairs(file, references, partial(read_line, known))
    scored = evaluate(pairs, known, environments.by_row(file, known, graph, homes), how)
    _show(scored, how, by, as_json)


def _show(scored: Sequence[Scored], how: Options, by: str | None, as_json: bool) -> None:
    from hearth.scoring.evaluate import by_field, summarise

    summary, groups = summarise(scored, how.seed), by_field(scored, by, how.seed) if by else {}
    if as_json:
        output.emit(_program_json(scored, how, summary, {"by": groups} if by else {}))
    else:
        _print_program(how, summary, by, groups)


def _program_json(
    scored: Sequence[Scored], how: Options, summary: Summary, groups: dict[str, dict[str, Summary]]
) -> dict[str, Any]:
    from hearth.scoring.evaluate import METRICS, signatures

    rows = [
        {
            "id": each.pair.id,
            **{name: value for name, metric in METRICS.items() if (value := metric(each)) is not None},
            "missing": each.missing,
            "error": each.execution and each.execution.error,
            "code": each.execution and each.execution.code,
            "failed_line": each.execution and each.execution.failed_line,
        }
        for each in scored
    ]
    parts = {key: {name: _summary_json(group) for name, group in found.items()} for key, found in groups.items()}
    return {"signatures": signatures(how), **_summary_json(summary), **parts, "scores": rows}


def _summary_json(summary: Summary) -> dict[str, Any]:
    counts = {name: getattr(summary, name) for name in ("count", "missing", "empty", "incomparable", "inexact")}
    return {**counts, "mean": summary.means, "errors": summary.errors, "failed_at": summary.failed_at}


def _print_program(how: Options, summary: Summary, by: str | None, groups: dict[str, Summary]) -> None:
    from hearth.scoring.evaluate import signatures

    output.table(["score", "mean", "95% from", "to"], [[name, *found] for name, found in summary.means.items()])
    if by:
        print()
        columns = list(summary.means)
        rows = [[name, group.count, *_means(group, columns)] for name, group in groups.items()]
        output.table([by, "rows", *columns], rows)
    if summary.errors:
        print()
        output.table(["first failure", "programs"], summary.errors.items())
    print(f"\n{_sentence(summary)}")
    for signature in signatures(how).values():
        print(signature)


def _means(group: Summary, columns: Sequence[str]) -> list[float | None]:
    return [group.means[name].mean if name in group.means else None for name in columns]


def _sentence(summary: Summary) -> str:
    text = f"{output.counted(summary.count, 'prediction')}, {summary.missing} missing, {summary.empty} empty"
    if summary.incomparable:
        text += f"; {summary.incomparable} without F1 and goal, because the reference does not run"
    if summary.inexact:
        text += f"; the F1 of {summary.inexact} is a lower bound, because there are too many assignments of instances"
    return text


@app.command("dataset")
def dataset(
    folder: options.Dataset,
    file: File,
    *,
    split: Annotated[str, typer.Option("--split", metavar="NAME", help="A split of the dataset; all if none.")] = "",
    part: Annotated[
        str, typer.Option("--part", metavar="NAME", help="A part of the split; `test` takes all tests.")
    ] = "test",
    match: Match = "best",
    scope: Scope = "either",
    instances: Instances = False,
    seed: Seed = 0,
    by: By = None,
    workers: options.Workers = 0,
    as_json: options.Json = False,
) -> None:
    """All scores against a dataset, whose programs are the references, in its environments.

    Each row of FILE is {"id": EXECUTION, "predicted": PROGRAM}, or {"program_id": PROGRAM, "home": HOME, "predicted":
    PROGRAM}; steps may be natural language. Executions without a row are missing predictions and score 0.

    \b
    Example:
      python cli.py score dataset data_out mine.jsonl --split activities --by activity
    """
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.dataset_scores import score_dataset
    from hearth.scoring.evaluate import Options

    how = Options(match=match, scope=scope, instances=instances, seed=seed)
    with bar("shares scored") as seen:
        scored = score_dataset(Dataset.open(folder), file, split, part if split else "", how, workers, seen)
    _show(scored, how, by, as_json)


@app.command("baselines")
def baselines(
    folder: options.Dataset,
    *,
    split: Annotated[str, typer.Option("--split", metavar="NAME", help="The split for training and test.")] = (
        "activities"
    ),
    seed: Seed = 0,
    as_json: options.Json = False,
) -> None:
    """All scores of simple baselines on a dataset's split, beside the thesis's tables 4.4, 4.5 and 5.2.

    Needs scikit-learn.

    \b
    Example:
      python cli.py score baselines data_out
    """
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.baselines import THESIS, Result
    from hearth.scoring.baselines import baselines as run

    found = run(Dataset.open(folder), split, seed)
    if as_json:
        output.emit({"split": split, "here": found, "thesis": THESIS})
        return
    output.table([name.replace("_", " ") for name in Result._fields], [*found, *THESIS])
    if not found:
        print("\nthe split has no original programs to learn from or to test on")


@app.command("graphs")
def graphs(
    predicted: Annotated[Path, typer.Argument(metavar="PREDICTED", help="The final graph after the prediction.")],
    reference: Annotated[Path, typer.Argument(metavar="REFERENCE", help="The final graph after the reference.")],
    *,
    nodes: Annotated[
        str, typer.Option("--nodes", metavar="IDS", help="The nodes that the programs name: 41,65 or 41,65/41.")
    ],
    match: Match = "best",
    scope: Scope = "either",
    as_json: options.Json = False,
) -> None:
    """Compare two final graphs of any origin: precision, recall and F1 over states, relations and both.

    A file is a scene graph, or a pair in the release's layout, of which the final graph is compared.

    \b
    Example:
      python cli.py score graphs mine.json theirs.json --nodes 41,65
    """
    from hearth.homes.library import read_graph
    from hearth.scoring.graph_files import node_ids
    from hearth.scoring.metrics.graph_f1 import f1_signature, score

    ours, theirs = node_ids(nodes)
    final, expected = (read_graph(path, "final_graph") for path in (predicted, reference))
    found = score(final, expected, ours, theirs, match=match, scope=scope)
    signature = f1_signature(match, scope)
    if as_json:
        parts = {name: getattr(found, name) for name in ("states", "relations", "both", "exact", "assigned")}
        output.emit({"signature": signature, **parts})
        return
    rows = [["states", *found.states], ["relations", *found.relations], ["both", *found.both]]
    output.table(["", "precision", "recall", "f1"], rows)
    print(f"\n{signature}{'' if found.exact else '; a lower bound'}")
