"""Agreement of annotators on which steps are the activity: the ceiling of inferred sketches (thesis 5.5.1)."""

from collections import defaultdict
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

from hearth.analysis.sketch_evaluation import Counts
from hearth.pipelines.readers import sketches as reader
from hearth.repair.sketch import Keep
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.scoring.bootstrap import intervals
from hearth.storage.rejects import Reject


def compare(first: Path, second: Path, seed: int = 0) -> dict[str, Any]:
    """F1 over steps and Cohen's kappa of two files of annotations, over the programs that both have.

    Given one file twice, its repeated annotations of one program are compared, each with the next.

    Returns:
        `programs`, `steps`, `f1`, `kappa`, `equal` (share of programs with equal sketches, with its 95% interval),
        `lengths` (steps kept on average by each), `other_lengths` (programs left out: their numbers of steps differ).

    Raises:
        HearthError: MISSING_FILE; EMPTY, no program is in both.
    """
    pairs = _repeated(first) if first.resolve() == second.resolve() else _in_both(first, second)
    same = [(one, other) for one, other in pairs if len(one) == len(other)]
    if not same:
        hint = "give two annotations of the same programs, by their ids in `prefix`"
        raise HearthError.of(Code.EMPTY, "no program is annotated twice", file=str(second), suggestion=hint)
    counts = Counts()
    for one, other in same:
        counts.add(one, other)
    equal = intervals({"equal": [float(one == other) for one, other in same]}, seed)["equal"]
    return {
        "programs": len(same),
        "steps": sum(len(one) for one, _ in same),
        "f1": counts.scores()["f1"],
        "kappa": kappa(same),
        "equal": [round(value, 3) for value in equal],
        "lengths": [round(sum(sum(pair[place]) for pair in same) / len(same), 2) for place in (0, 1)],
        "other_lengths": len(pairs) - len(same),
    }


def kappa(pairs: list[tuple[Keep, Keep]]) -> float:
    """Return Cohen's kappa over steps: agreement beyond the chance agreement of both shares of kept steps."""
    steps = [each for one, other in pairs for each in zip(one, other, strict=True)]
    observed = sum(one == other for one, other in steps) / len(steps)
    first, second = (sum(each[place] for each in steps) / len(steps) for place in (0, 1))
    expected = first * second + (1 - first) * (1 - second)
    return round((observed - expected) / (1 - expected), 4) if expected < 1 else 1.0


def _annotations(file: Path) -> Iterator[tuple[str, Keep]]:
    if not file.is_file():
        raise HearthError.of(Code.MISSING_FILE, "no such file", file=str(file))
    for item in reader.scan(file, file.name):
        row = reader.read(item) if item.reader == reader.NAME else None
        if row is not None and not isinstance(row, Reject):
            yield row["description_id"], tuple(row["keep"] or ())


def _in_both(first: Path, second: Path) -> list[tuple[Keep, Keep]]:
    other = dict(_annotations(second))
    return [(keep, other[name]) for name, keep in dict(_annotations(first)).items() if name in other]


def _repeated(file: Path) -> list[tuple[Keep, Keep]]:
    found: dict[str, list[Keep]] = defaultdict(list)
    for name, keep in _annotations(file):
        found[name].append(keep)
    return [pair for keeps in found.values() for pair in pairwise(keeps)]
