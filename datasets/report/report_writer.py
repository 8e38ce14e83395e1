"""Writes the report: one page, data in scripts that a browser loads from disk, and pictures."""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import orjson

from hearth.datasets.damage_faults import using
from hearth.datasets.dataset import OWN, Dataset
from hearth.datasets.format.datasheet import STRENGTH, datasheet
from hearth.datasets.places_outside import check_outside
from hearth.datasets.report.copied_pictures import copy_pictures, pictured
from hearth.datasets.report.floor_plan_svg import plans
from hearth.datasets.report.program_pages import DRAWN, Stories
from hearth.datasets.report.replays import write_replays
from hearth.datasets.report.report_tables import figures
from hearth.datasets.unpacked_sizes import check_unpacked
from hearth.repair.perturbation_strengths import MILD
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.row_types import Row
from hearth.schemas.terminal import without_controls
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, spread, unseen
from hearth.storage.templates import rendered

SHARD = 200
"""Programs per file of stories, which a browser loads when a program's page is opened."""


_ROW = "program_id, title, origin, split, len(steps) AS steps, activity_id, parent_id"


def write_report(dataset: Dataset, to: Path, workers: int = 1, seen: Seen = unseen, replays: int = 0) -> int:
    """Write the report of a dataset into a folder; the same files for any number of workers.

    `index.html` opens from disk, without a server. Browsers do not let such a page read JSON, so data is in scripts.
    `data/programs.js` has a short row per program, and `data/stories-N.js` the data of their pages. `data/home-N.js`
    and `data/replay-N.js` have some runs in 3D.

    Args:
        dataset: the dataset to report on.
        to: the folder.
        workers: processes.
        seen: reports the progress.
        replays: runs that can be watched in 3D.

    Returns:
        Number of programs.

    Raises:
        HearthError: the folder contains something else, or the tables cannot be read.
    """
    with using(dataset.folder):
        check_unpacked(dataset)
    check_outside(to, dataset.folder)
    if to.exists() and (not to.is_dir() or (any(to.iterdir()) and not (to / "index.html").exists())):
        message, remedy = "there is something else already", "name a new or empty folder, or an earlier report"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(to), suggestion=remedy)
    (to / "data").mkdir(parents=True, exist_ok=True)
    with using(dataset.folder):
        return _written(dataset, to, workers, seen, replays)


def _written(dataset: Dataset, to: Path, workers: int, seen: Seen, replays: int) -> int:
    """Write it all into a folder that is there; the number of programs."""
    rows = [[*row, *_pictured(row[0], looks)] for looks in (pictured(dataset),) for row in _rows(dataset)]
    (to / "data/programs.js").write_bytes(b"HEARTH.programs(" + orjson.dumps(rows) + b");\n")
    _write_stories(dataset, to, workers, seen)
    played = write_replays(dataset, to, replays)
    (to / "data/played.js").write_bytes(b"HEARTH.played(" + orjson.dumps(played) + b");\n")
    for name in ("app.js", "page.js", "replay.js", "style.css"):
        inside(to, name).write_bytes(files("hearth.datasets.report").joinpath("assets", name).read_bytes())
    (to / "index.html").write_text(_page(dataset, len(rows)), encoding="utf-8")
    copy_pictures(dataset, to)
    return len(rows)


def _pictured(program: str, looks: Mapping[str, tuple[str, bool]]) -> tuple[str, int]:
    """Return a program's picture, or "", and 2 if there is a film of it, 1 if there are pictures, else 0."""
    file, film = looks.get(program, ("", False))
    return file, 2 if film else int(program in looks)


def _page(dataset: Dataset, programs: int) -> str:
    versions = {name: dataset.manifest[name] for name in ("version", "action_set")}
    sheet = datasheet(dataset.folder, str(dataset.manifest.get(STRENGTH, MILD)))
    del sheet["bibtex"]
    values = {"plans": plans(dataset), "figures": figures(dataset), "sheet": sheet, "programs": programs, **versions}
    return without_controls(rendered("hearth.datasets.report", "assets/index.html", shard=SHARD, **values))


def _rows(dataset: Dataset) -> list[list[Any]]:
    """Return a row per program: id, title, origin, split, steps, number of homes, repairs, failure code."""
    query = f"""SELECT p.*,
            coalesce(e.homes, 0) AS homes, coalesce(e.code, '') AS code, coalesce(r.repairs, 0) AS repairs
        FROM (SELECT {_ROW} FROM programs) p
        LEFT JOIN (SELECT program_id, count(*) AS homes, min(failure.code) AS code FROM executions e WHERE {OWN}
            GROUP BY 1) e USING (program_id)
        LEFT JOIN (SELECT program_id, count(*) AS repairs FROM repairs GROUP BY 1) r USING (program_id)
        ORDER BY program_id"""
    columns, found = dataset.rows(query)
    wanted = [columns.index(name) for name in _LISTED]
    return [[row[place] for place in wanted] for row in found]


_LISTED = ("program_id", "title", "origin", "split", "steps", "homes", "repairs", "code")


def _write_stories(dataset: Dataset, to: Path, workers: int, seen: Seen) -> None:
    """Write the stories by program id, `SHARD` per file; processes write shares of the files."""
    names = [name for (name,) in dataset.rows("SELECT program_id FROM programs ORDER BY 1")[1]]
    shards = [names[start : start + SHARD] for start in range(0, len(names), SHARD)]
    bounds = [(number, shard[0], shard[-1]) for number, shard in enumerate(shards)]
    jobs = [(str(dataset.folder), str(to), bounds[start : start + _SHARE]) for start in range(0, len(bounds), _SHARE)]
    _opened.cache_clear()
    for _ in spread(_write_share, jobs, workers, seen):
        pass


_SHARE = 8
"""Files per unit of work."""

Shard = tuple[int, str, str]
"""A file's number, and the ids of its first and last program."""


@lru_cache(maxsize=1)
def _opened(folder: str) -> tuple[Dataset, Stories]:
    """Return a dataset and its homes, once a process."""
    dataset = Dataset.open(folder)
    return dataset, Stories(dataset)


def _write_share(job: tuple[str, str, list[Shard]]) -> None:
    folder, to, shards = job
    dataset, stories = _opened(folder)
    for shard in shards:
        _write_shard(dataset, stories, Path(to), shard)


def _write_shard(dataset: Dataset, stories: Stories, to: Path, shard: Shard) -> None:
    number, low, high = shard
    with dataset.connection.cursor() as cursor:
        found = list(_stories(cursor, stories, {"low": low, "high": high}))
    inside(to, f"data/stories-{number}.js").write_bytes(b"HEARTH.stories(" + orjson.dumps(found) + b");\n")


_PROGRAM_COLUMNS = "program_id, parent_id, title, description, origin, activity_id, steps"


def _stories(cursor: Any, stories: Stories, asked: dict[str, str]) -> Iterator[Row]:
    between = "program_id BETWEEN $low AND $high"
    runs, repairs = defaultdict(list), defaultdict(list)
    relations = ", ".join(f"'{name}'" for name in sorted(DRAWN))
    query = rendered("hearth.datasets.report", "runs.sql.jinja", relations=relations, own=OWN)
    for row in _ask(cursor, query, asked):
        runs[row["program_id"]].append(row)
    for row in _ask(cursor, f"SELECT * FROM repairs WHERE {between} ORDER BY program_id, attempt", asked):
        repairs[row["program_id"]].append(row)
    for program in _ask(
        cursor, f"SELECT {_PROGRAM_COLUMNS}, split FROM programs WHERE {between} ORDER BY program_id", asked
    ):
        name = program["program_id"]
        yield stories.story(program, runs[name], repairs[name])


def _ask(cursor: Any, query: str, asked: dict[str, str]) -> list[Any]:
    rows: list[Any] = cursor.sql(query, params=asked).to_arrow_table().to_pylist()
    return rows
