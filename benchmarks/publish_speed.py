"""How fast a published dataset is scored and asked: `python benchmarks/publish_speed.py DATASET`.

Predictions are the dataset's own programs, every second one with a step left out. Everything is done by one process;
the `score` command uses as many as there are cores.
"""

from __future__ import annotations

import json
import tempfile
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path

try:
    from benchmarks.measuring import Figure, Passes, finish, parser, passes, rate, runs, seconds, tell
except ImportError:
    from measuring import Figure, Passes, finish, parser, passes, rate, runs, seconds, tell

from hearth.pipelines.dataset import Dataset
from hearth.pipelines.judging import judge
from hearth.schemas.errors import HearthError
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.scoring.lcs import matrix

ASKED = 30_000
"""Predictions and executions that the targets are about."""

SLICES, SLICE = 12, 25
"""So many slices of so many predictions are scored, each several times over."""


def main() -> None:
    """Measure and print."""
    arguments = parser(__doc__)
    arguments.add_argument("dataset", type=Path, nargs="?", default=Path("data_out"), help="a build's folder")
    asked = arguments.parse_args()
    found = list(figures(asked))
    for figure in found:
        print(tell(figure))
    finish(found, asked.json)


def figures(asked: Namespace) -> Iterator[Figure]:
    """Every figure, in turn."""
    programs = drawn(5_000)
    yield seconds("LCS of 5,000 x 5,000 programs, one thread", runs(lambda: matrix(programs, programs, workers=1), 3),
                  target=4.0)  # fmt: skip
    try:
        dataset = Dataset.open(asked.dataset)
    except HearthError as error:
        print(f"no dataset to score and to ask: {error}")
        return
    with tempfile.TemporaryDirectory() as folder:
        taken = scored(dataset, Path(folder))
    yield rate("predictions scored by one process", SLICES * SLICE, taken, "predictions/s", ASKED / 120)
    some = dataset.rows("SELECT execution_id FROM executions ORDER BY hash(execution_id) LIMIT 9")[1]
    for macro in ("graph_edges", "graph_nodes"):
        query = f"SELECT * FROM {macro}($id, NULL)"
        each = [passes(lambda name, query=query: dataset.rows(query, id=name), one, 9) for one in some]
        worst = max(each, key=lambda one: one.least)
        yield seconds(f"one graph by SQL, {macro}, of {len(some)} the slowest", worst, "ms", 10.0)
    executions = dataset.rows("SELECT count(*) FROM executions")[1][0][0]
    yield seconds(f"edges per relation over {executions:,} executions",
                  passes(dataset.rows, ["SELECT * FROM start_relations"], 9),
                  target=executions / ASKED)  # fmt: skip


def scored(dataset: Dataset, folder: Path) -> Passes:
    """Scores slices of executions' predictions, each of neighbours, taken all over the dataset."""
    ids = [name for (name,) in dataset.rows("SELECT execution_id FROM executions WHERE executable ORDER BY 1")[1]]
    query = """SELECT execution_id, list_transform(steps, lambda s: step_text(s)) FROM executions JOIN programs
        USING (program_id) WHERE executable AND execution_id BETWEEN $first AND $last ORDER BY 1"""
    slices = []
    for number in range(SLICES):
        names = ids[number * len(ids) // SLICES :][:SLICE]
        kept = dataset.rows(query, first=names[0], last=names[-1])[1]
        told = [{"id": name, "predicted": steps[place % 2 :]} for place, (name, steps) in enumerate(kept)]
        file = folder / f"predictions-{number}.jsonl"
        file.write_text("".join(json.dumps(row) + "\n" for row in told))
        slices.append((_Some(dataset, names), file))
    return passes(lambda part: judge(*part), slices)


class _Some(Dataset):
    """A dataset of which only some executions are asked."""

    def __init__(self, dataset: Dataset, names: list[str]) -> None:
        super().__init__(dataset.folder, dataset.manifest)
        self._names = names

    def rows(self, query, limit=None, **parameters):
        if query.startswith("SELECT execution_id FROM executions WHERE executable"):
            return ["execution_id"], [(name,) for name in self._names]
        return super().rows(query, limit, **parameters)


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
