"""Writing the report: one page, its data in scripts that a browser reads from disk, pictures beside it."""

from __future__ import annotations

import shutil
from collections import defaultdict
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from typing import Any

import orjson

from hearth.pipelines.dataset import Dataset
from hearth.report.figures import figures
from hearth.report.plans import plans
from hearth.report.stories import Stories
from hearth.schemas.errors import HearthError
from hearth.schemas.failures import Code

SHARD = 200
"""Programs whose stories are in one file: what a reader waits for when a page is opened."""

Row = dict[str, Any]

_ROW = "program_id, title, origin, split, len(steps) AS steps, activity_id, parent_id"


def write_report(dataset: Dataset, to: Path) -> int:
    """Write the report of a dataset into a folder.

    `index.html` opens from disk, without a server. Browsers do not let such a page read JSON, so that data comes in
    scripts: `data/programs.js` has a short row a program, `data/stories-N.js` what their pages show.

    Returns:
        how many programs it has.

    Raises:
        HearthError: the folder holds something else.
    """
    if to.exists() and (not to.is_dir() or (any(to.iterdir()) and not (to / "index.html").exists())):
        message, remedy = "there is something else already", "name a new or empty folder, or an earlier report"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(to), suggestion=remedy)
    (to / "data").mkdir(parents=True, exist_ok=True)
    rows = _rows(dataset)
    (to / "data/programs.js").write_bytes(b"HEARTH.programs(" + orjson.dumps(rows) + b");\n")
    for number, stories in enumerate(_shards(dataset)):
        (to / f"data/stories-{number}.js").write_bytes(b"HEARTH.stories(" + orjson.dumps(stories) + b");\n")
    for name in ("app.js", "page.js", "style.css"):
        (to / name).write_bytes((files("hearth.report") / "assets" / name).read_bytes())
    (to / "index.html").write_text(_page(dataset, len(rows)), encoding="utf-8")
    _pictures(dataset, to)
    return len(rows)


def _page(dataset: Dataset, programs: int) -> str:
    import jinja2

    text = (files("hearth.report") / "assets" / "index.html").read_text("utf-8")
    template = jinja2.Environment(autoescape=True, trim_blocks=True, lstrip_blocks=True).from_string(text)
    told = {name: dataset.manifest[name] for name in ("version", "action_set")}
    drawn = plans(dataset)
    return template.render(figures=figures(dataset), plans=drawn, programs=programs, shard=SHARD, **told)


def _rows(dataset: Dataset) -> list[list[Any]]:
    """A row a program: id, title, origin, split, steps, homes it runs in, what went wrong, repairs."""
    query = f"""SELECT p.*,
            coalesce(e.homes, 0) AS homes, coalesce(e.code, '') AS code, coalesce(r.repairs, 0) AS repairs
        FROM (SELECT {_ROW} FROM programs) p
        LEFT JOIN (SELECT program_id, count(*) AS homes, min(failure.code) AS code FROM executions GROUP BY 1) e
            USING (program_id)
        LEFT JOIN (SELECT program_id, count(*) AS repairs FROM repairs GROUP BY 1) r USING (program_id)
        ORDER BY program_id"""
    columns, found = dataset.rows(query)
    wanted = [columns.index(name) for name in _LISTED]
    return [[row[place] for place in wanted] for row in found]


_LISTED = ("program_id", "title", "origin", "split", "steps", "homes", "repairs", "code")


def _shards(dataset: Dataset) -> Iterator[list[Row]]:
    """Stories by program id, `SHARD` at a time."""
    stories = Stories(dataset)
    with dataset.connection.cursor() as cursor:
        names = [name for (name,) in cursor.sql("SELECT program_id FROM programs ORDER BY 1").fetchall()]
        for start in range(0, len(names), SHARD):
            asked = {"low": names[start], "high": names[min(start + SHARD, len(names)) - 1]}
            yield list(_stories(cursor, stories, asked))


def _stories(cursor: Any, stories: Stories, asked: dict[str, str]) -> Iterator[Row]:
    between = "program_id BETWEEN $low AND $high"
    programs = _ask(cursor, f"SELECT * FROM programs WHERE {between} ORDER BY program_id", asked)
    environments = {
        row["environment_id"]: row for row in _ask(cursor, f"SELECT * FROM environments WHERE {between}", asked)
    }
    runs, repairs = defaultdict(list), defaultdict(list)
    for row in _ask(cursor, f"SELECT * FROM executions WHERE {between} ORDER BY execution_id", asked):
        runs[row["program_id"]].append({**row, "environment": environments[row["environment_id"]]})
    for row in _ask(cursor, f"SELECT * FROM repairs WHERE {between} ORDER BY program_id, attempt", asked):
        repairs[row["program_id"]].append(row)
    for program in programs:
        name = program["program_id"]
        yield stories.story(program, runs[name], repairs[name])


def _ask(cursor: Any, query: str, asked: dict[str, str]) -> list[Row]:
    rows: list[Row] = cursor.sql(query, params=asked).to_arrow_table().to_pylist()
    return rows


def _pictures(dataset: Dataset, to: Path) -> None:
    for (name,) in dataset.rows("SELECT DISTINCT file FROM frames WHERE modality = 'rgb' ORDER BY 1")[1]:
        source, target = dataset.folder / name, to / name
        if source.is_file() and source.resolve().is_relative_to(dataset.folder.resolve()) and ".." not in name:
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
