"""Error detection: precision and recall of faults in a corpus with known faults."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from hearth.kb.knowledge import Knowledge
from hearth.pipelines import validate
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items, read
from hearth.schemas.stage_rows import IngestedRow
from hearth.storage.csv_files import CsvTable
from hearth.storage.rejects import Reject

LARGEST_KEY = 16 << 20
"""Bytes of a key, at most: all of it is in memory."""

IGNORED = frozenset({"NOT_SIMULATED"})
"""Warnings that do not indicate a fault of the author."""


@dataclass(slots=True)
class Found:
    """Detected codes by record, and the number of records."""

    codes: dict[str, set[str]] = field(default_factory=dict)
    records: int = 0


@dataclass(frozen=True, slots=True)
class Score:
    """Detection of one kind of fault."""

    fault: str
    labelled: int
    found: int
    codes: tuple[tuple[str, int], ...]

    @property
    def recall(self) -> float:
        """Share of the labelled records that were found, by any code."""
        return self.found / self.labelled if self.labelled else 1.0


@dataclass(frozen=True, slots=True)
class Report:
    """Scores by fault, and overall; `false` counts detected records that the key does not list."""

    scores: tuple[Score, ...]
    false: tuple[tuple[str, int], ...]
    precision: float
    recall: float
    rejected_precision: float


def find(paths: Iterable[str], known: Knowledge) -> Found:
    """Read and check sources as `ingest` and `validate` do; returns rejects and warnings by record."""
    found = Found()
    for _, item in items(labelled(paths)):
        found.records += 1
        name = item.record_id.rpartition(":")[2]
        for row in read(item):
            codes = _codes(row, known)
            if codes:
                found.codes.setdefault(name, set()).update(codes)
    return found


def _codes(row: IngestedRow | Reject, known: Knowledge) -> set[str]:
    if isinstance(row, Reject):
        return {f"!{fault.code}" for fault in row.diagnostics}
    if row["kind"] != "program":
        return set()
    done = validate.process({**row, "groundings": None}, known)
    refused = {f"!{fault.code}" for one in done if isinstance(one, Reject) for fault in one.diagnostics}
    return refused or {w["code"] for one in done if not isinstance(one, Reject) for w in one["warnings"]} - IGNORED


def read_key(path: Path) -> dict[str, str]:
    """Record -> its fault, from a CSV with the columns HITId and fault; errors as of `CsvTable`."""
    return {record: fault for _, (record, fault) in CsvTable(path, ("HITId", "fault"), LARGEST_KEY).rows()}


def score(found: Found, key: dict[str, str]) -> Report:
    """Compare detected with labelled faults. Codes of rejects begin with `!`, the others are warnings."""
    kinds = Counter(key.values())
    scores = []
    for fault, count in sorted(kinds.items()):
        hits = [found.codes[name] for name, kind in key.items() if kind == fault and name in found.codes]
        codes = Counter(code for each in hits for code in each)
        scores.append(Score(fault, count, len(hits), tuple(codes.most_common(3))))
    wrong = Counter(code for name, codes in found.codes.items() if name not in key for code in codes)
    right = sum(name in key for name in found.codes)
    rejected = [name for name, codes in found.codes.items() if any(code.startswith("!") for code in codes)]
    return Report(
        tuple(scores),
        tuple(wrong.most_common()),
        right / max(1, len(found.codes)),
        right / max(1, len(key)),
        sum(name in key for name in rejected) / max(1, len(rejected)),
    )
