"""Splits of synthetic descriptions that hold out paraphrases, tasks, pairs of tasks or objects, and statistics."""

import io
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

from hearth.analysis.synthesis import Synthetic
from hearth.datasets.format.near_duplicates import near_texts
from hearth.datasets.format.split_columns import NEAR, normalised
from hearth.schemas.rng import derive
from hearth.storage import chosen_files
from hearth.storage.csv_files import rows_writer

SPLITS = {
    "paraphrases": "test: descriptions that use the paraphrases held out, wherever a clause has such",
    "tasks": "test: programs with a task of which train has no program",
    "pairs": "test: programs with a pair of tasks that train has only apart",
    "objects": "test: programs with an object of which train has no program",
}
"""The held-out part of each split.

A tenth of the rest is `validation`. Near duplicates of a later part have no part.
"""

_OUT = {"tasks": 10, "pairs": 6, "objects": 30}
"""One name of this number is held out."""


class SplitText(NamedTuple):
    """The part of a description in a split; None for a near duplicate of one in a later part."""

    split: str
    program: int
    description: int
    part: str | None


def splits(programs: Sequence[Synthetic], seed: int = 0) -> list[SplitText]:
    """Return the part of every description in every split, by number of the program, from 1, and of its description,
    from 0.

    Args:
        programs: in the order of their numbers.
        seed: of the held-out names; those that `paraphrases` holds out are the same for every seed.
    """
    texts = [(number, place) for number, one in enumerate(programs, 1) for place in range(len(one.descriptions))]
    near = _near([normalised(programs[number - 1].descriptions[place]) for number, place in texts])
    found = []
    for split in SPLITS:
        parts = [_part(split, programs[number - 1], place, number, seed) for number, place in texts]
        for (number, place), part in zip(texts, _apart(parts, near), strict=True):
            found.append(SplitText(split, number, place, part))
    return found


def _part(split: str, one: Synthetic, place: int, number: int, seed: int) -> str:
    if split == "paraphrases":
        out = one.held_out[place]
    else:
        names = _names(split, one)
        out = any(derive(seed, "held out", split, name) % _OUT[split] == 0 for name in names)
    if out:
        return "test"
    return "validation" if derive(seed, "synthetic part", number) % 10 == 0 else "train"


def _names(split: str, one: Synthetic) -> list[str]:
    if split == "tasks":
        return list(one.tasks)
    if split == "pairs":
        return ["+".join(pair) for pair in combinations(sorted(one.tasks), 2)]
    return sorted({name for _, names in one.steps for name in names})


def _near(texts: Sequence[str]) -> list[list[int]]:
    """Return for each text the places of equal and nearly equal ones."""
    found: list[list[int]] = [[] for _ in texts]
    places: dict[str, list[int]] = {}
    for place, text in enumerate(texts):
        places.setdefault(text, []).append(place)
    different = sorted(places)
    alike = [(places[different[one]], places[different[other]]) for one, other in near_texts(different, NEAR)]
    pairs = [(a, b) for some, others in alike for a in some for b in others]
    pairs += [pair for same in places.values() for pair in combinations(same, 2)]
    for one, other in pairs:
        found[one].append(other)
        found[other].append(one)
    return found


_ORDER = ("train", "validation", "test")


def _apart(parts: Sequence[str], near: Sequence[Sequence[int]]) -> Iterator[str | None]:
    """Yield the parts, without those of which a near duplicate is in a later part."""
    for part, like in zip(parts, near, strict=True):
        later = any(_ORDER.index(parts[other]) > _ORDER.index(part) for other in like)
        yield None if later else part


def figures(programs: Sequence[Synthetic], rows: Sequence[SplitText] = ()) -> dict[str, Any]:
    """Sizes and variety: tasks, pairs, triples, word types, distinct 4-grams, and descriptions by split and part."""
    texts = [re.findall(r"[^\W_]+", text.lower()) for one in programs for text in one.descriptions]
    used = Counter(word for text in texts for word in text)
    grams = [gram for text in texts for gram in zip(*(text[start:] for start in range(4)), strict=False)]
    sizes = Counter(len(one.tasks) for one in programs)
    counted: dict[str, Counter[str]] = {}
    for row in rows:
        counted.setdefault(row.split, Counter())[row.part or "none"] += 1
    return {
        "programs": len(programs),
        "descriptions": len(texts),
        "tasks": len({task for one in programs for task in one.tasks}),
        "programs_by_tasks": dict(sorted(sizes.items())),
        "steps": round(sum(len(one.steps) for one in programs) / max(1, len(programs)), 2),
        "words": round(sum(map(len, texts)) / max(1, len(texts)), 2),
        "word_types": len(used),
        "word_types_used_three_times": sum(count > 2 for count in used.values()),
        "distinct_4_grams": round(len(set(grams)) / max(1, len(grams)), 4),
        "splits": {name: dict(sorted(counts.items())) for name, counts in counted.items()},
    }


def of_first(rows: Sequence[SplitText]) -> dict[int, dict[str, str | None]]:
    """Return the part of each program's first description in every split, by number of the program."""
    found: dict[int, dict[str, str | None]] = {}
    for row in rows:
        if row.description == 0:
            found.setdefault(row.program, {})[row.split] = row.part
    return found


def write(rows: Sequence[SplitText], seed: int, path: Path) -> None:
    """Write the parts of descriptions as CSV: split, program id, number of the description, part."""
    table = io.StringIO()
    write_rows = rows_writer(table)
    write_rows([("split", "program_id", "description", "part")])
    write_rows((row.split, f"synthetic:{seed}:{row.program}", row.description, row.part or "") for row in rows)
    chosen_files.write(path, table.getvalue().encode())
