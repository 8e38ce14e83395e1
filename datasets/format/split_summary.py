"""A summary of splits: their parts, and the leakage between them, compared with a random split."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hearth.datasets.format.split_columns import NEAR, SplitPrograms
from hearth.datasets.format.split_runs import Runs
from hearth.datasets.format.splits import RULES, SplitRows, held_out
from hearth.schemas.rng import derive

OWN = "by program: the parts that its source gives; augmented programs have those of their originals"
"""The rule of a split that comes with a source."""

_SPANS = ((1, 4), (5, 5), (5, 6), (1, 5), (6, 7))

Places = NDArray[np.int64]
"""Places of programs, in order."""


def summary(programs: SplitPrograms, runs: Runs, rows: SplitRows, seed: int) -> dict[str, Any]:
    """Homes in order, and for each split rule, counts of runs and programs by part, and leakage, as JSON.

    `leakage` counts test programs with a program in train that has the same original (`siblings`), nearly the same
    steps (`steps`), or nearly the same description (`texts`); `at_random` is the leakage of a random split of equal
    size.

    Args:
        programs: all published programs.
        runs: as of `SplitRows`.
        rows: of these runs.
        seed: of the assignment.
    """
    homes, out = runs.homes, held_out(runs, seed)
    spans = {f"{first}_{last}": ", ".join(homes[first - 1 : last]) or "none here" for first, last in _SPANS}
    described = {}
    for split, rule in {**RULES, **dict.fromkeys(rows.own, OWN)}.items():
        members = Members.of(rows.parts(split), len(programs.ids))
        if split in RULES or members.runs:
            described[split] = {"rule": rule.format(held_out=out, **spans), **_measured(members, programs, seed)}
    return {"seed": seed, "near": NEAR, "homes": homes, "held_out": out, "splits": described}


@dataclass(slots=True)
class Members:
    """The runs and programs of a split's parts: counts of runs, and programs as (ids,) masks."""

    runs: Counter[str | None] = field(default_factory=Counter)
    programs: dict[str, NDArray[np.bool_]] = field(default_factory=dict)

    @classmethod
    def of(cls, runs: Iterable[tuple[str, int, str | None]], programs: int) -> Members:
        """Return the members of a split's runs, as `SplitRows.parts` gives them; `programs` is the number of ids."""
        found = cls()
        for _, place, part in runs:
            found.runs[part] += 1
            if part:
                if part not in found.programs:
                    found.programs[part] = np.zeros(programs, bool)
                found.programs[part][place] = True
        return found


def _measured(members: Members, programs: SplitPrograms, seed: int) -> dict[str, Any]:
    parts = dict(sorted(members.programs.items()))
    train = np.flatnonzero(parts["train"]) if "train" in parts else np.zeros(0, np.int64)
    tested = np.zeros(len(programs.ids), bool)
    for part, mask in parts.items():
        tested |= mask if part.startswith("test") else False
    test = np.flatnonzero(tested)
    return {
        "runs": {part: members.runs[part] for part in parts},
        "runs_without_part": members.runs[None],
        "programs": {part: int(mask.sum()) for part, mask in parts.items()},
        "leakage": leakage(programs, train, test),
        "at_random": leakage(programs, *_at_random(programs, np.concatenate([train, test]), len(test), seed)),
    }


def _at_random(programs: SplitPrograms, places: Places, tested: int, seed: int) -> tuple[Places, Places]:
    keys = (derive(seed, "random split", programs.ids[place]) for place in places.data)
    shuffled = places[np.argsort(np.fromiter(keys, np.uint64, len(places)), kind="stable")]
    return shuffled[tested:], shuffled[:tested]


def leakage(programs: SplitPrograms, train: Places, test: Places) -> dict[str, int]:
    """Return the number of test programs with a sibling, similar steps or a similar description in train."""
    steps, texts = programs.steps, programs.texts
    return {
        "programs": len(test),
        "siblings": int(np.isin(programs.root[test], programs.root[train]).sum()),
        "steps": int(steps.among(steps.around(train), test).sum()),
        "texts": int(texts.among(texts.around(train), test).sum()),
    }
