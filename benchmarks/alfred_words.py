"""Models on the words of ALFRED's people: trained without and with its training sample, scored on its unseen rooms.

The dataset is a build of our corpus and of the archive: `hearth build data_raw/crowd data_raw/written ALFRED.zip
--out FOLDER --variants 0 --homes-each 1 --pictures 0 --videos 0`. Nothing of the archive is kept elsewhere. A model
sees the title and the first description, and writes a program; the scores are the means of normalised LCS with the
program that was carried out, of steps and of actions, and the share of programs that are equal.

Example:
  python benchmarks/alfred_words.py build/with_alfred
  python benchmarks/alfred_words.py build/with_alfred --markdown   # the table of docs/models.md
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from hearth.datasets.dataset import Dataset
from hearth.models.interface import Steps, Training
from hearth.models.reading.reader import Reader
from hearth.models.reading.reader_recall import ReaderRecall
from hearth.models.text.retrieval import Nearest
from hearth.models.text.retrieve_edit import RetrieveEdit
from hearth.models.text_examples import Corpus, Example, example_of
from hearth.scoring.bootstrap import intervals
from hearth.scoring.metrics import lcs

MODELS = {"nearest": Nearest(), "retrieve-edit": RetrieveEdit(), "reader": Reader(), "reader-recall": ReaderRecall()}

_PROGRAMS = """
    SELECT program_id, activity_id, title, description, steps, origin, place, NULL AS keep, [] AS runs
    FROM programs WHERE parent_id IS NULL ORDER BY program_id
"""


def main() -> None:
    """Print a line for each model and training part, or with `--markdown` a table."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("dataset", type=Path)
    options.add_argument("--test", default="valid_unseen", help="files of ALFRED whose path has this text are tests")
    options.add_argument("--markdown", action="store_true", help="mean LCS of steps and of actions, with intervals")
    given = options.parse_args()
    dataset = Dataset.open(given.dataset)
    ours, theirs, test = parts(dataset, given.test)
    trained_on = {"ours": ours, "ours and ALFRED": (*ours, *theirs), "ALFRED": theirs}
    rows: dict[str, dict[str, Mapping[str, Any]]] = {}
    for name, settings in MODELS.items():
        for what, train in trained_on.items() if name != "reader" else [("nothing", ours)]:
            model = settings.fit(Corpus(dataset, "", train, ()), Training())
            found = model.predict([each.request for each in test])
            rows.setdefault(name, {})[what] = scores(found, test)
            if not given.markdown:
                print(json.dumps({"model": name, "trained on": what, "programs": len(train), "tests": len(test),
                                  **rows[name][what]}))  # fmt: skip
    if given.markdown:
        print(markdown(rows, list(trained_on)))


def markdown(rows: Mapping[str, Mapping[str, Mapping[str, Any]]], parts: Sequence[str]) -> str:
    """Return a table of a row for each model and a column for each training part; steps first, then actions."""
    lines = [f"| model | {' | '.join(parts)} |", "|---" * (len(parts) + 1) + "|"]
    for name, found in rows.items():
        cells = [_cell(found[part] if part in found else found["nothing"]) for part in parts]
        lines.append(f"| `{name}`{'' if parts[0] in found else ' (has no training)'} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _cell(score: Mapping[str, Any]) -> str:
    """Return both means with their intervals: `38.3 (33.0-43.1), 67.0 (62.9-70.9)`."""
    return ", ".join(f"{score[name]:.1f} ({score[name + ' between'][0]:.1f}-{score[name + ' between'][1]:.1f})"
                     for name in ("lcs of steps", "lcs of actions"))  # fmt: skip


def parts(dataset: Dataset, tested: str) -> tuple[tuple[Example, ...], tuple[Example, ...], tuple[Example, ...]]:
    """Return the programs with a description that are not of ALFRED, those of ALFRED to train on, and the tests."""
    ours: list[Example] = []
    theirs: list[Example] = []
    test: list[Example] = []
    for row in dataset.read(_PROGRAMS, {}):
        part = ours if row["origin"] != "alfred" else test if tested in row["place"] else theirs
        if row["title"] or row["description"]:
            part.append(example_of(row))
    return tuple(ours), tuple(theirs), tuple(test)


def scores(found: Sequence[Steps], test: Sequence[Example]) -> Mapping[str, Any]:
    """Return mean scores of predicted programs, in percent, with their intervals: 95 %, by bootstrap over programs."""
    pairs = [(got, each.steps) for got, each in zip(found, test, strict=True)]
    each = lcs.score_pairs(pairs)
    columns: dict[str, list[float | None]] = {
        "lcs of steps": [100 * score.step for score in each],
        "lcs of actions": [100 * score.action for score in each],
        "equal": [100.0 * (got == own) for got, own in pairs],
    }
    made = intervals(columns, 0)
    return {
        **{name: round(each.mean, 1) for name, each in made.items()},
        **{f"{name} between": [round(each.low, 1), round(each.high, 1)] for name, each in made.items()},
        "without a program": sum(not got for got, _ in pairs),
    }


if __name__ == "__main__":
    main()
