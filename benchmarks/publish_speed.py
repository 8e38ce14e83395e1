"""Speed of scoring and queries on a published dataset: `python benchmarks/publish_speed.py DATASET`.

Predictions are the dataset's own programs, every second one without its first step. Everything runs in one process; the
`score` command uses one per core.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from statistics import median
from time import perf_counter
from typing import Any

import plain_reference
from measurement import Figure, Passes, as_line, finish, parser, passes, rate, runs, seconds

from hearth.datasets.dataset import Dataset
from hearth.datasets.execution_graphs import ExecutionGraphs
from hearth.datasets.format.row_conversion import bindings_of, program_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.scoring import dataset_scores
from hearth.scoring.evaluate import Options, Pair, lcs_of
from hearth.scoring.metrics.lcs import matrix

ASKED = 30_000
"""Numbers of predictions and executions of the targets."""

PAIRS = 1_000
"""Executions whose graphs are read."""

SHARES, EACH = 8, 25
"""Number of shares of predictions that are read, and of predictions scored in each."""


def main() -> None:
    """Measure and print."""
    arguments = parser(__doc__)
    arguments.add_argument("dataset", type=Path, nargs="?", default=Path("data_out/full"), help="a build's folder")
    asked = arguments.parse_args()
    found = list(figures(asked))
    for figure in found:
        print(as_line(figure))
    finish(found, asked.json)


def figures(asked: Namespace) -> Iterator[Figure]:
    """Every figure, in turn."""
    programs = drawn(5_000)
    textbook = plain_reference.textbook_lcs(programs)
    for workers, target in ((1, 4.0), (2, 2.0)):
        taken = runs(lambda workers=workers: matrix(programs, programs, workers=workers), 5, perf_counter)
        yield seconds(f"LCS of 5,000 x 5,000 programs, by {workers}", taken, target=target,
                      ratio=textbook.ratio(len(programs) ** 2, taken))  # fmt: skip
    try:
        dataset = Dataset.open(asked.dataset)
    except HearthError as error:
        print(f"no dataset to score and to ask: {error}")
        return
    yield from scoring(dataset)
    read, counted = yardsticks()
    some = dataset.rows("SELECT execution_id FROM executions WHERE executable ORDER BY hash(execution_id) LIMIT 9")[1]
    for macro in ("graph_edges", "graph_nodes"):
        query = f"SELECT * FROM {macro}($id, NULL)"
        each = [passes(lambda name, query=query: dataset.rows(query, id=name), one, 9) for one in some]
        worst = max(each, key=lambda one: one.least)
        yield seconds(f"one graph by SQL, {macro}, of {len(some)} the slowest", worst, "ms", 10.0, read.ratio(1, worst))
    run_of = {name: next(run for run in dataset[name.split("@")[0]].runs if run.row["execution_id"] == name)
              for (name,) in some}  # fmt: skip
    each = [passes(lambda run: run.final, [run], 9) for run in run_of.values()]
    worst = max(each, key=lambda one: one.least)
    yield seconds(f"one graph by the library, of {len(some)} the slowest, rows read before", worst, "ms", 10.0,
                  read.ratio(1, worst))  # fmt: skip
    graphs = ExecutionGraphs(dataset)
    number = min(PAIRS, len(graphs))
    pairs = passes(lambda most: sum(1 for _ in islice(graphs, most)), [number], 5)
    yield seconds(f"start and end graphs of {number:,} executions, by the iterator", pairs, target=5.0,
                  ratio=read.ratio(2 * number, pairs))  # fmt: skip
    executions = dataset.rows("SELECT count(*) FROM executions")[1][0][0]
    counting = passes(dataset.rows, ["SELECT * FROM start_relations"], 9)
    yield seconds(f"edges per relation over {executions:,} executions", counting, target=executions / ASKED,
                  ratio=counted.ratio(executions, counting))  # fmt: skip


def yardsticks() -> tuple[plain_reference.Yardstick, plain_reference.Yardstick]:
    """Reading a graph from JSON, and counting relations in one."""
    graphs = [plain_reference.as_dicts(library.load_graph(name, default())) for name in library.names()]
    return plain_reference.read_graph(graphs), plain_reference.counted_relations(graphs)


def scoring(dataset: Dataset) -> Iterator[Figure]:
    """The cost of a prediction, read in shares of neighbours as in the `score` command, and scored one by one."""
    folder = str(dataset.folder)
    _, homes = dataset_scores.opened(folder)
    ids = [name for (name,) in dataset.rows("SELECT execution_id FROM executions WHERE executable ORDER BY 1")[1]]
    shares = [ids[number * len(ids) // SHARES :][: dataset_scores.PART] for number in range(SHARES)]
    reading = passes(lambda share: list(stored_cases(dataset, share)), shares, 9)
    cases = {case["execution_id"]: case for share in shares for case in stored_cases(dataset, share[:EACH])}
    pairs = [
        dataset_scores._filled(Pair(name, predicted(case, place), ()), case)
        for place, (name, case) in enumerate(cases.items())
    ]
    options = Options()

    def score(pair: Pair) -> object:
        return list(
            dataset_scores._scored(cases[pair.id], [(pair, *lcs_of([pair], options.instances))], homes, options)
        )

    taken = passes(score, pairs, 9)
    read = sum(map(len, shares))
    yield rate("predictions' references read", read, reading, "a second")
    yield rate("predictions scored", len(pairs), taken, "a second")
    least, usual = (
        ASKED * (a / read + b / len(pairs)) / 2
        for a, b in ((reading.least, taken.least), (median(reading.totals), median(taken.totals)))
    )
    whole = Passes([usual], least)
    yield seconds(f"score of {ASKED:,} predictions by two processors, from these", whole, target=60.0,
                  ratio=plain_reference.sampled_runs().ratio(ASKED / 2, whole))  # fmt: skip


def predicted(case: dict[str, Any], place: int) -> tuple[Step, ...]:
    """The case's own program; every second one without its first step."""
    return program_of(case, bindings_of(case["bindings"])).unbound().steps[place % 2 :]


def drawn(number: int) -> list[tuple[Step, ...]]:
    """Programs of about ten steps over 40 actions and 100 objects."""
    random = rng(0, "lcs", "speed")
    return [
        tuple(Step(f"A{random.randrange(40)}", (ObjectRef(f"o{random.randrange(100)}"),))
              for _ in range(random.randint(5, 15)))
        for _ in range(number)
    ]  # fmt: skip


if __name__ == "__main__":
    main()
