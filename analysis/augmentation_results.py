"""Results of augmentation: outcomes of pairs, and figures compared with the thesis's (table 5.1, figure 5-4)."""

from collections import Counter
from pathlib import Path
from typing import Any

import orjson
import pyarrow.parquet as pq

from hearth.datasets.damage_faults import reading, using
from hearth.datasets.format.datasheet import STRENGTH
from hearth.datasets.graph_sizes import graph_sizes
from hearth.pipelines.augment import ORIGINAL
from hearth.repair.perturbation_strengths import MILD
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.manifest import TIMING, read_manifest

THESIS: dict[str, dict[str, float | None]] = {
    "collected": {"programs": 2807, "average_length": 13.26, "average_nodes": None, "average_edges": None},
    "executable": {"programs": 1387, "average_length": 9.61, "average_nodes": 289, "average_edges": 4393},
    "augmented": {"programs": 27284, "average_length": 18.58, "average_nodes": 290, "average_edges": 4305},
    "all": {"programs": 32761, "average_length": 18.79, "average_nodes": 289, "average_edges": 4319},
}
"""Table 5.1. Its parts do not sum up: 1,387 + 27,284 is 28,671, not 32,761."""

SHOWN_CLASSES = ("cup", "sauce_pan")
"""Classes in figure 5-4."""


def outcome(folder: Path) -> dict[str, Any]:
    """Return numbers of tried pairs of a program and a perturbed environment, by outcome.

    Raises:
        HearthError: MISSING_FILE, if the stage has not run.
    """
    manifest = read_manifest(folder)
    if manifest is None:
        raise HearthError.of(Code.MISSING_FILE, "nothing was augmented here", file=str(folder))
    with reading(folder):
        rejects = pq.read_table(folder / "rejects.parquet", columns=["code", "message", "fault"]).to_pylist()
        seconds = orjson.loads((folder / TIMING).read_bytes())["seconds"]
    idle = sum(row["code"] == Code.UNPERTURBED and "where" not in row["message"] for row in rejects)
    codes = Counter(row["code"] for row in rejects if row["fault"] == 0)
    codes[str(Code.UNPERTURBED)] -= idle
    programs = manifest.counts.tally.total() - manifest.counts.tally[ORIGINAL]
    tried = programs + codes.total()
    given_up = sum(codes[str(code)] for code in GIVEN_UP)
    return {
        "executions": manifest.counts.records_in,
        "nothing_to_perturb": idle,
        "pairs_tried": tried,
        "repaired": programs + codes[str(Code.DUPLICATE)],
        "repaired_share": round(1 - given_up / tried, 4) if tried else None,
        "rejected": dict(sorted((+codes).items(), key=lambda each: (-each[1], each[0]))),
        "programs_out": programs,
        "seconds": seconds,
    }


GIVEN_UP = (
    Code.NO_HANDLER, Code.HANDLER_ERROR, Code.LOOP, Code.TOO_MANY_TRIES, Code.GOAL_LOST, Code.CIRCUMSTANCES_LOST
)  # fmt: skip
"""Codes of pairs that were not repaired; other pairs were repaired, ran without repair, or were not sampled."""

LENGTHS = (5, 10, 15, 20, 25, 30, 40, 50)
"""Upper ends of the classes in which lengths are counted."""

_GROUPS = {"executable": "parent_id IS NULL", "augmented": "parent_id IS NOT NULL"}


def figures(dataset: Path) -> dict[str, Any]:
    """Return the numbers of table 5.1 and figure 5-4 for a published dataset, with the thesis's.

    Returns:
        `strength` of augmenting; `table`: programs, lengths, nodes and edges of ours and the thesis's; `lengths`:
        programs by length before and after augmenting; `conditions`: for each class of `SHOWN_CLASSES`, how often each
        condition names it before and after, as shares; `near_duplicates`: pairs of one parent's children in one home
        with the same steps; `executable_share`: of the programs that were valid, those with an environment in which
        they run.

    Raises:
        HearthError: MISSING_FILE, without a dataset; DAMAGED_FILE, with a damaged one.
    """
    from hearth.datasets.dataset import Dataset

    data = Dataset.open(dataset)
    with using(data.folder):
        return {
            "strength": data.manifest.get(STRENGTH, MILD),
            "table": {name: {"ours": _row(data, name), "thesis": thesis} for name, thesis in THESIS.items()},
            "lengths": {name: _lengths(data, name) for name in ("executable", "augmented")},
            "conditions": {name: _conditions(data, name) for name in SHOWN_CLASSES},
            "near_duplicates": _near_duplicates(data),
            "executable_share": _share(data),
            "bytes_a_program": _bytes(dataset, data),
        }


def _row(data: Any, group: str) -> dict[str, float | None]:
    """One column of table 5.1; nodes and edges are those of the executions' environments."""
    if group == "collected":
        ((programs,),) = data.rows("SELECT records_through FROM ledger WHERE stage = 'validate'")[1]
        return {"programs": programs, "average_length": None, "average_nodes": None, "average_edges": None}
    found = graph_sizes(data, group)
    means = {"average_length": found.length, "average_nodes": found.nodes, "average_edges": found.edges}
    return {"programs": found.programs, **means}


def _lengths(data: Any, group: str) -> dict[str, int]:
    """Return numbers of programs by length class, named by its upper end; the last is open."""
    rows = data.rows(f"SELECT len(steps), count(*) FROM programs WHERE {_GROUPS[group]} GROUP BY 1")[1]
    found = dict.fromkeys([*(f"up to {end}" for end in LENGTHS), "more"], 0)
    for length, count in rows:
        end = next((end for end in LENGTHS if length <= end), None)
        found["more" if end is None else f"up to {end}"] += count
    return found


def _conditions(data: Any, name: str) -> dict[str, dict[str, float]]:
    """Shares of the conditions whose first object is of a class, before and after perturbation."""
    found: dict[str, dict[str, float]] = {}
    for label, where in (("before", "NOT IN"), ("after", "IN")):
        query = f"""
            WITH literal AS (SELECT unnest(conditions) AS c FROM environments
                          WHERE environment_id {where} (SELECT environment_id FROM perturbations))
            SELECT c.name, count(*) FROM literal WHERE c.objects[1].name = $name GROUP BY 1 ORDER BY 2 DESC, 1"""
        rows = data.rows(query, name=name)[1]
        total = sum(count for _, count in rows) or 1
        for condition, count in rows:
            found.setdefault(condition, {"before": 0.0, "after": 0.0})[label] = round(count / total, 4)
    return found


def _near_duplicates(data: Any) -> int:
    """Return the number of augmented programs with the steps of a sibling in the same home."""
    query = """
        WITH child AS (SELECT DISTINCT p.program_id, p.parent_id, e.home, p.steps
                       FROM programs p JOIN executions e USING (program_id) WHERE p.parent_id IS NOT NULL),
             steps_of AS (SELECT program_id, parent_id, home,
                             list_transform(steps, lambda s: {'a': s.action, 'o': s.objects, 'g': s.agent}) AS plain
                      FROM child)
        SELECT count(*) - count(DISTINCT (parent_id, home, plain)) FROM steps_of"""
    return int(data.rows(query)[1][0][0])


def _share(data: Any) -> float | None:
    """Share of valid programs with an environment in which they run."""
    rows = dict(data.rows("SELECT stage, records_through FROM ledger WHERE stage IN ('validate', 'sample')")[1])
    return round(rows["sample"] / rows["validate"], 4) if rows.get("validate") else None


def _bytes(dataset: Path, data: Any) -> int | None:
    """Bytes of programs, environments, executions and repairs on disk, per execution."""
    tables = ("programs", "environments", "executions", "perturbations", "repairs")
    size = sum(path.stat().st_size for table in tables for path in dataset.rglob(f"{table}/part-*.parquet"))
    (count,) = data.rows("SELECT count(*) FROM executions")[1][0]
    return round(size / count) if count else None
