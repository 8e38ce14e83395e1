"""What augmenting gave: outcomes of pairs, and figures beside those of the thesis (table 5.1, figure 5-4)."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from hearth.pipelines.manifest import TIMING, read_manifest
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

THESIS: dict[str, dict[str, float | None]] = {
    "collected": {"programs": 2807, "average_length": 13.26, "average_nodes": None, "average_edges": None},
    "executable": {"programs": 1387, "average_length": 9.61, "average_nodes": 289, "average_edges": 4393},
    "augmented": {"programs": 27284, "average_length": 18.58, "average_nodes": 290, "average_edges": 4305},
    "all": {"programs": 32761, "average_length": 18.79, "average_nodes": 289, "average_edges": 4319},
}
"""Table 5.1. Its parts do not add up: 1,387 + 27,284 is 28,671, not 32,761."""

SHOWN_CLASSES = ("cup", "sauce_pan")
"""The classes whose conditions figure 5-4 shows; here a pan, whatever it is called."""


def outcome(folder: Path) -> dict[str, Any]:
    """Pairs of a program and a perturbed environment that were tried, and what became of them, by code.

    Raises:
        HearthError: MISSING_FILE, when the stage has not been run.
    """
    import orjson
    import pyarrow.parquet as pq

    manifest = read_manifest(folder)
    if manifest is None:
        raise HearthError.of(Code.MISSING_FILE, "nothing was augmented here", file=str(folder))
    rejects = pq.read_table(folder / "rejects.parquet", columns=["code", "message", "fault"]).to_pylist()
    idle = sum(row["code"] == Code.UNPERTURBED and "where" not in row["message"] for row in rejects)
    codes = Counter(row["code"] for row in rejects if row["fault"] == 0)
    codes[str(Code.UNPERTURBED)] -= idle
    programs = manifest.counts.rows[""]
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
        "seconds": orjson.loads((folder / TIMING).read_bytes())["seconds"],
    }


GIVEN_UP = (Code.NO_HANDLER, Code.HANDLER_ERROR, Code.LOOP, Code.TOO_MANY_TRIES, Code.GOAL_LOST)
"""Why a pair was not repaired; the others were, or needed no repair, or could not be drawn."""
