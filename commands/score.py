"""`score`: compares predicted programs with their references."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import typer

from hearth.commands import inputs, output

if TYPE_CHECKING:
    from hearth.scoring.evaluate import Options, Scored, Summary
    from hearth.scoring.predictions import Pair

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    help="Score predicted programs against references.",
)


@app.command("lcs")
def lcs(
    file: Path,
    *,
    references: Path | None = None,
    instances: bool = False,
    seed: int = 0,
    as_json: bool = False,
) -> None:
    """Longest common subsequence over the longer program's length, by step, by action and by object, and their mean.

    Objects are compared by class, in the columns `instances` by node, `(1.41)`; by number if a program names no node.
    Each row of FILE is {"id": ..., "predicted": PROGRAM, "reference": PROGRAM}; a program is a text or a list of steps,
    which may be natural language. A prediction is missing and scores 0 if it is null or if only the references have its
    id; lines that are not steps are counted.

    \b
    Example:
      echo '{"id": "tv", "predicted": ["[Walk] <sofa> (1)"], "reference": ["[Sit] <sofa> (1)"]}' > mine.jsonl
      python cli.py score lcs mine.jsonl
    """
    from functools import partial

    from hearth.scoring.bootstrap import intervals
    from hearth.scoring.dataset_scores import read_line
    from hearth.scoring.evaluate import METRICS, Scored, lcs_of
    from hearth.scoring.metrics.lcs import LEVELS, lcs_signature
    from hearth.scoring.predictions import read_pairs

    pairs = read_pairs(file, references, partial(read_line, inputs.read_knowledge(None)))
    scored = [Scored(pair, *both) for pair, both in zip(pairs, lcs_of(pairs, instances), strict=True)]
    shown = {name.removeprefix("lcs_"): metric for name, metric in METRICS.items() if name.startswith("lcs_")}
    columns = {name: [metric(each) for each in scored] for name, metric in shown.items()}
    means = intervals(columns, seed)
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    signatures = [lcs_signature("+".join(LEVELS), instances), lcs_signature("step+object", instances=True)]
    counts = {"count": len(pairs), **{name: sum(_note(pair) == name for pair in pairs) for name in NOTES}}
    if as_json:
        named = [{"id": pair.id, **row, "missing": pair.predicted is None, "unread": _unread(pair)}
                 for pair, row in zip(pairs, rows, strict=True)]  # fmt: skip
        output.emit({"signature": signatures[0], "signature_instances": signatures[1], **counts,
                     "mean": means, "scores": named})  # fmt: skip
        return
    table = [[pair.id, *row.values(), _note(pair)] for pair, row in zip(pairs, rows, strict=True)]
    for place, name in enumerate(("mean", "95% from", "to")):
        table.append([name, *(found[place] for found in means.values()), ""])
    output.table(["id", *(name.replace("_", " ") for name in means), ""], table)
    noted = ", ".join(f"{counts[name]} {words}" for name, words in NOTES.items())
    print(f"\n{output.counted(len(pairs), 'reference')}; predictions: {noted}")
    print("\n".join(signatures))


NOTES = {"missing": "missing", "empty": "empty", "unread": "with lines that are not steps"}


def _note(pair: Pair) -> str:
    if pair.predicted is None:
        return "missing"
    return "unread" if _unread(pair) else "" if pair.predicted else "empty"


def _unread(pair: Pair) -> int:
    """The number of predicted lines that are not steps."""
    return sum(isinstance(line, str) for line in pair.predicted or ())


@app.command("program")
def program(
    file: Path,
    *,
    references: Path | None = None,
    graph: Path | None = None,
    homes: Path | None = None,
    rules: Literal["default", "replay", "evolving_graph"] = "default",
    match: Literal["none", "swap1", "best"] = "swap1",
    scope: Literal["either", "own"] = "own",
    instances: bool = False,
    seed: int = 0,
    by: str | None = None,
    as_json: bool = False,
) -> None:
    """All scores: LCS and parsability; for rows with an environment also executability, final-graph F1 and goal.

    Rows are those of `score lcs`. The environment is a row's `graph` (a scene graph's file, relative to FILE's folder)
    or `home` (a name), or else --graph. The goal is what the reference achieves there,
    or a row's own (`goal`), which the signature counts. Steps may be natural language. Actions are read by --rules:
    ours, those of the release of 2018 (replay), or those of VirtualHome 2.x and the Embodied Agent Interface
    (evolving_graph).

    \b
    Example:
      python cli.py score program predictions.jsonl --graph home.json --by activity
    """
    from functools import partial

    from hearth.scoring import environments
    from hearth.scoring.dataset_scores import read_line
    from hearth.scoring.evaluate import Options, evaluate
    from hearth.scoring.predictions import read_pairs
    from hearth.simulation.rules import CHOICES

    how = Options(CHOICES[rules], match, scope, instances, seed)
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
        _print_program(_signatures(scored, how), summary, by, groups)


def _signatures(scored: Sequence[Scored], how: Options) -> dict[str, str]:
    from hearth.scoring.evaluate import given_goal, signatures

    return signatures(how, sum(given_goal(each.pair) is not None for each in scored))


def _program_json(
    scored: Sequence[Scored], how: Options, summary: Summary, groups: dict[str, dict[str, Summary]]
) -> dict[str, Any]:
    from hearth.scoring.evaluate import METRICS

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
    return {"signatures": _signatures(scored, how), **_summary_json(summary), **parts, "scores": rows}


def _summary_json(summary: Summary) -> dict[str, Any]:
    counts = {name: getattr(summary, name) for name in ("count", "missing", "empty", "incomparable", "inexact")}
    return {**counts, "mean": summary.means, "errors": summary.errors, "failed_at": summary.failed_at}


def _print_program(signed: dict[str, str], summary: Summary, by: str | None, groups: dict[str, Summary]) -> None:
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
    for signature in signed.values():
        print(signature)


def _means(group: Summary, columns: Sequence[str]) -> list[float | None]:
    return [group.means[name].mean if name in group.means else None for name in columns]


def _sentence(summary: Summary) -> str:
    text = (
        f"{output.counted(summary.count, 'reference')}; predictions: {summary.missing} missing, {summary.empty} empty"
    )
    if summary.incomparable:
        text += f"; {summary.incomparable} without F1 and goal, because the reference does not run"
    if summary.inexact:
        text += f"; the F1 of {summary.inexact} is a lower bound, because there are too many assignments of instances"
    return text


@app.command("dataset")
def dataset(
    folder: Path,
    file: Path,
    *,
    split: str = "",
    part: str | None = None,
    match: Literal["none", "swap1", "best"] = "swap1",
    scope: Literal["either", "own"] = "own",
    instances: bool = False,
    seed: int = 0,
    by: str | None = None,
    failures: bool = False,
    workers: int = 0,
    as_json: bool = False,
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

    if failures and split:
        raise typer.BadParameter("splits have no failing executions", param_hint="--failures")
    if part is not None and not split:
        raise typer.BadParameter("name the split whose part it is with --split", param_hint="--part")
    how = Options(match=match, scope=scope, instances=instances, seed=seed)
    asked = "test" if split and part is None else part or ""
    with bar("shares scored") as seen:
        opened = Dataset.open(folder, failures)
        scored = score_dataset(opened, file, split, asked, how, workers, seen)
    _show(scored, how, by, as_json)


@app.command("baselines")
def baselines(folder: Path, *, split: str = ("activities"), seed: int = 0, as_json: bool = False) -> None:
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
        print(f"\nsplit `{split}` has no original programs to learn from or to test on: build from more activities")


@app.command("graphs")
def graphs(
    predicted: Path,
    reference: Path,
    *,
    nodes: str,
    match: Literal["none", "swap1", "best"] = "swap1",
    scope: Literal["either", "own"] = "own",
    as_json: bool = False,
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
