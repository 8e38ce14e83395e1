"""How fast a published dataset is scored and asked: `python benchmarks/publish_speed.py DATASET`.

Predictions are the dataset's own programs, every second one with a step left out. Seconds are of processor, of one
process; scoring uses as many as there are cores, so that two cores take half of the time it says.
"""

from __future__ import annotations

import json
import tempfile
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path

try:
    from benchmarks.measuring import Figure, finish, parser, runs, seconds, tell
except ImportError:
    from measuring import Figure, finish, parser, runs, seconds, tell

from hearth.pipelines.dataset import Dataset
from hearth.pipelines.judging import judge
from hearth.schemas.errors import HearthError
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.scoring.lcs import matrix

ASKED = 30_000
"""Predictions and executions that the targets are about."""

SCORED = 3_000


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
        taken = [each * ASKED / SCORED for each in runs(scoring(dataset, Path(folder)), 1)]
    yield seconds(f"score of {ASKED:,} predictions, one process", taken, target=120.0)
    some = dataset.rows("SELECT execution_id FROM executions ORDER BY hash(execution_id) LIMIT 9")[1]
    names = [name for (name,) in some]
    for macro in ("graph_edges", "graph_nodes"):
        query = f"SELECT * FROM {macro}($id, NULL)"
        each = [runs(lambda name=name, query=query: dataset.rows(query, id=name), 1)[0] for name in names]
        yield seconds(f"one graph by SQL, {macro}", each, "ms", 10.0)
    executions = dataset.rows("SELECT count(*) FROM executions")[1][0][0]
    counted = runs(lambda: dataset.rows("SELECT * FROM start_relations"))
    yield seconds(f"edges per relation over {ASKED:,} executions", [each * ASKED / executions for each in counted],
                  target=1.0)  # fmt: skip


def scoring(dataset: Dataset, folder: Path) -> object:
    """Scores `SCORED` executions' predictions."""
    query = """SELECT execution_id, list_transform(steps, lambda s: step_text(s)) FROM executions JOIN programs
        USING (program_id) WHERE executable ORDER BY execution_id"""
    rows = dataset.rows(query)[1]
    every = max(1, len(rows) // SCORED)
    file = folder / "predictions.jsonl"
    chosen = {name for name, _ in rows[::every][:SCORED]}
    kept = [(name, steps) for name, steps in rows if name in chosen]
    told = [{"id": name, "predicted": steps[number % 2 :]} for number, (name, steps) in enumerate(kept)]
    file.write_text("".join(json.dumps(row) + "\n" for row in told))
    some = _Some(dataset, sorted(chosen))
    return lambda: judge(some, file)


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
