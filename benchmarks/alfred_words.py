"""Models on the words of ALFRED's people: trained without and with its training sample, scored on its unseen rooms.

The dataset is a build of our corpus and of the archive: `hearth build data_raw/crowd data_raw/written ALFRED.zip
--out FOLDER --variants 0 --homes-each 1 --pictures 0 --videos 0`. Nothing of the archive is kept elsewhere. A model
sees the title and the first description, and writes a program; the scores are the means of normalised LCS with the
program that was carried out, of steps and of actions, and the share of programs that are equal.

Example:
  python benchmarks/alfred_words.py build/with_alfred
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from pathlib import Path

from hearth.datasets.dataset import Dataset
from hearth.models.interface import Steps, Training
from hearth.models.reading.reader import Reader
from hearth.models.reading.reader_recall import ReaderRecall
from hearth.models.text.retrieval import Nearest
from hearth.models.text.retrieve_edit import RetrieveEdit
from hearth.models.text_examples import Corpus, Example, example_of
from hearth.scoring.metrics import lcs

MODELS = {"nearest": Nearest(), "retrieve-edit": RetrieveEdit(), "reader": Reader(), "reader-recall": ReaderRecall()}

_PROGRAMS = """
    SELECT program_id, activity_id, title, description, steps, origin, place, NULL AS keep, [] AS runs
    FROM programs WHERE parent_id IS NULL ORDER BY program_id
"""


def main() -> None:
    """Print a line for each model and training part."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("dataset", type=Path)
    options.add_argument("--test", default="valid_unseen", help="files of ALFRED whose path has this text are tests")
    given = options.parse_args()
    dataset = Dataset.open(given.dataset)
    ours, theirs, test = parts(dataset, given.test)
    trained_on = {"ours": ours, "ours and ALFRED": (*ours, *theirs), "ALFRED": theirs}
    for name, settings in MODELS.items():
        for what, train in trained_on.items() if name != "reader" else [("nothing", ours)]:
            model = settings.fit(Corpus(dataset, "", train, ()), Training())
            found = model.predict([each.request for each in test])
            print(json.dumps({"model": name, "trained on": what, "programs": len(train), "tests": len(test),
                              **scores(found, test)}))  # fmt: skip


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


def scores(found: Sequence[Steps], test: Sequence[Example]) -> Mapping[str, float]:
    """Return mean scores of predicted programs, in per cent."""
    pairs = [(got, each.steps) for got, each in zip(found, test, strict=True)]
    each = lcs.score_pairs(pairs)
    return {
        "lcs of steps": round(100 * sum(score.step for score in each) / len(each), 1),
        "lcs of actions": round(100 * sum(score.action for score in each) / len(each), 1),
        "equal": round(100 * sum(got == own for got, own in pairs) / len(pairs), 1),
        "without a program": sum(not got for got, _ in pairs),
    }


if __name__ == "__main__":
    main()
