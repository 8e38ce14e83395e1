"""Every export format of datasets."""

from collections.abc import Callable
from pathlib import Path

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import Dataset
from hearth.datasets.export.coco import coco
from hearth.datasets.export.graphs import graphml, node_link
from hearth.datasets.export.jsonl_and_csv import csv, jsonl
from hearth.datasets.export.natural_language import nl
from hearth.datasets.export.pddl_problems import pddl
from hearth.datasets.export.program_batches import Wanted
from hearth.datasets.export.python_code import code
from hearth.datasets.export.rdf import rdf
from hearth.datasets.export.release_layout import release
from hearth.datasets.places_outside import check_outside
from hearth.datasets.unpacked_sizes import check_unpacked
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

FORMATS: dict[str, Callable[[Dataset, Path, Wanted], int]] = {
    "release": release,
    "nl": nl,
    "jsonl": jsonl,
    "csv": csv,
    "code": code,
    "networkx": node_link,
    "graphml": graphml,
    "rdf": rdf,
    "pddl": pddl,
    "coco": coco,
}
"""Each writes a dataset, or some of its programs, into a folder and returns the number of written items."""

COUNTED = {"release": "execution", "jsonl": "line", "networkx": "execution", "graphml": "execution", "pddl": "problem",
           "csv": "row", "coco": "picture"}  # fmt: skip
"""The items that a format counts, if not programs."""


def export(dataset: Dataset, form: str, to: Path, wanted: Wanted | None = None) -> int:
    """Write a dataset in one of `FORMATS` into a folder.

    Raises:
        HearthError: the form or a program's id is unknown, the folder is not empty, or the tables cannot be read.

    Examples:
        >>> hearth.export(hearth.load(folder), "nl", Path("words"))
        4
        >>> sorted(path.name for path in Path("words").iterdir())
        ['chat.jsonl', 'examples.json', 'steps.jsonl']
    """
    if form not in FORMATS:
        raise HearthError.of(Code.UNSUPPORTED_FILE, f"unknown form `{form}`", suggestion=f"one of {', '.join(FORMATS)}")
    wanted = wanted or Wanted()
    with using(dataset.folder):
        check_unpacked(dataset)
    missing = [name for name in wanted.programs if name not in dataset]
    if missing:
        raise HearthError.of(Code.UNKNOWN_ID, f"no program `{missing[0]}` in this dataset", file=str(dataset.folder))
    check_outside(to, dataset.folder)
    if to.exists() and (not to.is_dir() or any(to.iterdir())):
        message, remedy = "there is something already", "name a new or empty folder"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(to), suggestion=remedy)
    with using(dataset.folder):
        return FORMATS[form](dataset, to, wanted)
