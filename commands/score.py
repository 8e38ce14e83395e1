"""`score`: compares predicted programs with their references."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import typer

from hearth.commands import inputs, output, score_output
from hearth.kb.language.reading_modes import Fuzzy

if TYPE_CHECKING:
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
    fuzzy: Fuzzy = Fuzzy.TYPOS,
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
      hearth score lcs mine.jsonl
    """
    from hearth.scoring.bootstrap import intervals
    from hearth.scoring.evaluate import lcs_of
    from hearth.scoring.line_reader import LineReader
    from hearth.scoring.metrics.lcs import LEVELS, lcs_signature
    from hearth.scoring.prediction_scores import METRICS, Scored
    from hearth.scoring.predictions import read_pairs
    from hearth.scoring.refused_rows import FirstFaults

    rejects = FirstFaults()
    pairs = read_pairs(file, references, LineReader(inputs.read_knowledge(None), fuzzy), rejects=rejects)
    scored = [Scored(pair, *both) for pair, both in zip(pairs, lcs_of(pairs, instances), strict=True)]
    shown = {name.removeprefix("lcs_"): metric for name, metric in METRICS.items() if name.startswith("lcs_")}
    columns = {name: [metric(each) for each in scored] for name, metric in shown.items()}
    means = intervals(columns, seed)
    rows = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    signatures = [lcs_signature("+".join(LEVELS), instances), lcs_signature("step+object", instances=True)]
    counts = {"count": len(pairs), **{name: sum(_note(pair) == name for pair in pairs) for name in NOTES}}
    if as_json:
        named = [{"id": pair.id, **row, "missing": pair.predicted is None, "unread": _unread(pair), "fuzzy": pair.fuzzy}
                 for pair, row in zip(pairs, rows, strict=True)]  # fmt: skip
        output.emit({"signature": signatures[0], "signature_instances": signatures[1], **counts,
                     **score_output.rejects_json(rejects), "mean": means, "scores": named})  # fmt: skip
        score_output.end(rejects)
        return
    table = [[pair.id, *row.values(), _note(pair)] for pair, row in zip(pairs, rows, strict=True)]
    for place, name in enumerate(("mean", "95% from", "to")):
        table.append([name, *(found[place] for found in means.values()), ""])
    output.table(["id", *(name.replace("_", " ") for name in means), ""], table)
    noted = ", ".join(f"{counts[name]} {words}" for name, words in NOTES.items())
    output.line(f"\n{output.counted(len(pairs), 'reference')}; predictions: {noted}")
    output.line("\n".join(signatures))
    score_output.end(rejects)


NOTES = {"missing": "missing", "empty": "empty", "unread": "with lines that are not steps"}


def _note(pair: Pair) -> str:
    if pair.predicted is None:
        return "missing"
    return "unread" if _unread(pair) else "" if pair.predicted else "empty"


def _unread(pair: Pair) -> int:
    """Return the number of predicted lines that are not steps."""
    return sum(isinstance(line, str) for line in pair.predicted or ())


@app.command("program")
def program(
    file: Path,
    *,
    references: Path | None = None,
    graph: Path | None = None,
    home: str = "",
    homes: Path | None = None,
    rules: Literal["auto", "default", "replay", "evolving_graph", "consequences"] = "auto",
    match: Literal["none", "swap1", "best"] = "swap1",
    scope: Literal["either", "own"] = "own",
    instances: bool = False,
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    safety: bool = False,
    seed: int = 0,
    by: str | None = None,
    as_json: bool = False,
) -> None:
    """Print all scores of predictions, or of any programs: without references, all scores that need none.

    FILE has the rows of `score lcs`, or programs in any form that `check` reads. With a reference a row has LCS and
    final-graph F1. Without one it has parsability and, in an environment, executability, first failures, and `goal` if
    the row has a goal (`goal`). The environment is the row's `home` (a name) or `graph` (a scene graph's file, relative
    to FILE's folder), else --home or --graph; with `--homes all`, each of our homes. A goal is else what the reference
    achieves; conditions that hold at the start do not count (`goal_whole` counts them). Steps may be natural language.
    Rows that can't be read are left out and counted; the status is then 1. Actions are read by --rules: ours, those of
    the release of 2018 (replay), those of VirtualHome 2.x and the Embodied Agent Interface (evolving_graph), or action
    set 3 (consequences); `auto` takes VirtualHome's for a --graph in which no two things are CLOSE, as `run` does, and
    ours otherwise. --safety, by action set 3, counts hazards, irreversible changes and waste next to the reference's.
    `safety` is the share that runs, reaches its goal and does no further harm; a program that does nothing has 0.

    \b
    Examples:
      hearth score program predictions.jsonl --graph home.json --by activity
      hearth score program plans.txt --home maple
      hearth score program predictions.jsonl --home maple --safety
    """
    from hearth.commands.score_inputs import ALL, in_homes, read_predictions
    from hearth.homes.library import names
    from hearth.scoring import environments
    from hearth.scoring.evaluate import Options, evaluate
    from hearth.scoring.metrics.safety import safety_signature
    from hearth.scoring.refused_rows import FirstFaults
    from hearth.simulation.rules import CHOICES

    rules = _with_consequences(rules) if safety else rules
    known, rejects = inputs.of_rules(inputs.read_knowledge(None, "", graph), rules), FirstFaults()
    auto = inputs.read_rules(rules, inputs.read_home("", graph, None, known)) if graph else CHOICES["default"]
    chosen = auto if rules == "auto" else CHOICES[rules]
    how = Options(chosen, match, scope, instances, seed, safety_signature(known) if safety else "")
    pairs = read_predictions(file, references, known, rejects, fuzzy)
    if homes and str(homes) == ALL:
        pairs, homes, by = in_homes(pairs, names()), None, by or environments.HOME
    scored = evaluate(pairs, known, environments.by_row(file, known, graph, homes, home), how, rejects)
    score_output.show(scored, how, by, rejects, as_json)
    if not any(each.placed for each in scored):
        output.note("No program has an environment, so none was run: name a home with --home, or give --homes all.")
    score_output.end(rejects)


def _with_consequences(rules: str) -> Literal["consequences"]:
    """Return the rules by which harm is judged; others are a fault of the command line."""
    if rules not in ("auto", "consequences"):
        raise typer.BadParameter("harm is judged by action set 3: --rules consequences", param_hint="--safety")
    return "consequences"


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
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    seed: int = 0,
    by: str | None = None,
    failures: bool = False,
    only_given: bool = False,
    originals: bool = False,
    workers: int = 0,
    as_json: bool = False,
) -> None:
    """Print all scores against a dataset, whose programs are the references, in its environments.

    Each row of FILE is {"id": EXECUTION, "predicted": PROGRAM}, or {"program_id": PROGRAM, "home": HOME, "predicted":
    PROGRAM}; steps may be natural language. Executions without a row are missing predictions and score 0, unless
    --only-given leaves them out. This is the benchmark; `model score` is the same with --only-given, and intervals by
    activity.

    \b
    Examples:
      hearth score dataset data_out mine.jsonl --split activities --by activity
      hearth score dataset data_out mine.jsonl --split activities --originals
    """
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.dataset_scores import score_dataset
    from hearth.scoring.evaluate import Options
    from hearth.scoring.refused_rows import FirstFaults

    if failures and split:
        raise typer.BadParameter("splits have no failing executions", param_hint="--failures")
    if part is not None and not split:
        raise typer.BadParameter("name the split whose part it is with --split", param_hint="--part")
    rejects = FirstFaults()
    how = Options(match=match, scope=scope, instances=instances, seed=seed)
    asked = "test" if split and part is None else part or ""
    with bar("shares scored") as seen:
        opened = Dataset.open(folder, failures)
        chosen: Any = {"only_given": only_given, "originals": originals, "fuzzy": fuzzy}
        scored = score_dataset(opened, file, split, asked, how, workers, seen, rejects=rejects, **chosen)
    score_output.show(scored, how, by, rejects, as_json)
    score_output.warn_missing(scored)
    score_output.end(rejects)


@app.command("baselines")
def baselines(folder: Path, *, split: str = ("activities"), seed: int = 0, as_json: bool = False) -> None:
    """Print all scores of simple baselines on a dataset's split, next to the thesis's tables 4.4, 4.5 and 5.2.

    The thesis's rows have the source `thesis`: they are its figures, of its own data.
    Needs scikit-learn.

    \b
    Example:
      hearth score baselines data_out
    """
    from hearth.datasets.dataset import Dataset
    from hearth.scoring.baselines import THESIS, THESIS_NOTE, Result
    from hearth.scoring.baselines import baselines as run

    found = run(Dataset.open(folder), split, seed)
    if as_json:
        output.emit({"split": split, "thesis_note": THESIS_NOTE, "here": found, "thesis": THESIS})
        return
    output.table([name.replace("_", " ") for name in Result._fields], [*found, *THESIS])
    output.line(f"\n{THESIS_NOTE}")
    if not found:
        output.line(
            f"\nsplit `{split}` has no original programs to learn from or to test on: build from more activities"
        )


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
      hearth score graphs mine.json theirs.json --nodes 41,65
    """
    from hearth.homes.library import read_graph
    from hearth.scoring.metrics.graph_f1 import f1_signature, score
    from hearth.scoring.node_ids_option import node_ids

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
    output.line(f"\n{signature}{'' if found.exact else '; a lower bound'}")
