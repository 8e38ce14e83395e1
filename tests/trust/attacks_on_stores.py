"""Attacks by the folders of servers of strangers: their stores, what people handed in there, what was made of it."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import sqlalchemy as sql
from attack import Attack, Ground
from attacks_on_studies import JUDGED

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.study_file import study_of
from hearth.studies.study_findings import findings
from hearth.studies.study_folder import EVENTS, FILMS, opened
from hearth.studies.study_report import page
from hearth.studies.study_tables import archive, person_of
from hearth.web.annotate.annotate_tables import ACCEPTED, MARKS, PROGRAMS, TEXTS
from hearth.web.annotate.collected_files import collected, ratings_sheet
from hearth.web.sessions import start
from hearth.web.store import Store, default_url, embedded
from hearth.web.study.study_store import FOLDER, conducted, opened_store

BAD: tuple[Any, ...] = (
    None, "", -1, 1e300, 2**62, "9" * 5_000, "../../guard/x", b"\xff\xfe", "[" * 90_000, "null", "[[]]", '{"x": 1}',
    "<script>alert(1)</script>", "\u202e\x1b[2J",
)  # fmt: skip
"""Values that somebody could write into a cell: SQLite keeps any kind of value in any column."""

DRAFT = '{"rooms": {"bedroom": 1}, "props": {"bed": 1}, "steps": [{"action": "Lie", "things": [["bed", 1]]}]}'


@cache
def served() -> tuple[TemporaryDirectory[str], Path]:
    """A server's folder with a study that somebody took part in, and a program that was accepted, with its marks."""
    made = TemporaryDirectory()
    out = Path(made.name) / "collected"
    store = Store(default_url(out))
    conduct = conducted(store, study_of(JUDGED, "judging.yaml"), default)
    person = start(store).id
    conduct.join(person)
    conduct.consent(person)
    standing = conduct.standing(person)
    while standing.stage in ("trial", "questions", "exit"):
        if standing.stage == "trial":
            standing = conduct.watched(person, 2.0)
        else:
            standing = conduct.answer(person, {"quality": 3} if standing.stage == "questions" else {})
    text = {
        "id": "T1",
        "session": person,
        "scene": "bedroom",
        "title": "Rest",
        "description": "Lie down.",
        "created": 1,
    }
    program = {
        "id": "P1",
        "session": person,
        "text": "T1",
        "draft": DRAFT,
        "version": 1,
        "state": ACCEPTED,
        "created": 1,
    }
    values = {
        "sketch": "[true]",
        "completeness": "1",
        "film": '{"title": "a", "description": "b", "program": "[Sleep]"}',
    }
    marks = [{"id": kind, "session": person, "kind": kind, "subject": "P1", "value": value, "created": 1}
             for kind, value in values.items()]  # fmt: skip
    store.write(lambda connection: [connection.execute(sql.insert(table), rows) for table, rows in (
        (TEXTS, [text]), (PROGRAMS, [program]), (MARKS, marks))])  # fmt: skip
    store.close()
    films = [JudgedFilm(0, "written", "000-a", "a", "Rest: lie down", "maple", 0.5, ["[Sleep]"]).as_json()]
    folder = out / FOLDER / "judging"
    folder.mkdir(parents=True)
    (folder / FILMS).write_text(json.dumps(films))
    return made, out


def used(out: Path) -> Any:
    """All that is made of a server's folder: tables and page of its study, files for `build`, a person forgotten."""
    from hearth.pipelines.engine.source_labels import labelled
    from hearth.pipelines.ingest import items, read

    try:
        found = opened_store(out, "", "", default)
        shown = page(findings(found), [])
        assert "<script>alert(1)" not in shown
        archive(found)
        for person in found.ledger.streams()[:1]:
            found.conduct.forget(person_of(found, person))
    except HearthError as error:
        shown = str(error)
    store = Store(default_url(out))
    try:
        files = {**collected(store), "ratings.csv": ratings_sheet(store).encode()}
    finally:
        store.close()
    made = out / "files"
    made.mkdir()
    for name, data in files.items():
        (made / name).write_bytes(data)
    return shown, [row for _, item in items(labelled([str(made)])) for row in read(item)]


def events() -> bytes:
    """The same study as the file of a simulation."""
    import orjson

    from hearth.studies.events import PLACES, event_data
    from hearth.studies.study_folder import header

    found = opened_store(served()[1], "", "", default)
    every = [each for stream in (PLACES, *found.ledger.streams()) for each in found.ledger.read(stream)]
    lines = [header(found.study, 0, 0), *map(event_data, every)]
    return b"".join(orjson.dumps(line) + b"\n" for line in lines)


def reported(folder: Path, data: bytes) -> Any:
    """The page and the tables of events."""
    (folder / EVENTS).write_bytes(data)
    (folder / FILMS).write_bytes((served()[1] / FOLDER / "judging" / FILMS).read_bytes())
    found = opened(folder, default)
    archive(found)
    return page(findings(found), [])


def _whole(ground: Ground) -> None:
    """Check that the store is read as long as nothing is changed."""
    shown, rows = used(_copy(ground))
    assert shown.startswith("<!doctype html>") and len(rows) > 3, shown[:200]


def stores() -> Iterator[Attack]:
    """Every column of the tables of studies and annotations with other values, and other files than a store."""
    yield Attack("stores", "as it is", _whole)
    tables = {
        "study_studies": ("name", "text", "salt"),
        "study_places": ("study", "number", "place", "at", "session"),
        "study_events": ("study", "session", "number", "kind", "at", "data"),
        "annotate_texts": ("id", "scene", "title", "description", "created"),
        "annotate_programs": ("text", "draft", "version", "state"),
        "annotate_marks": ("kind", "subject", "value"),
    }
    for table, columns in tables.items():
        for column in columns:
            for bad in BAD:
                change = f'UPDATE OR IGNORE {table} SET "{column}" = ?'
                yield Attack("stores", f"{table}.{column} = {bad!r:.16}", lambda ground, c=change, b=bad: _changed(
                    ground, lambda store: store.execute(c, (b,))))  # fmt: skip
    for draft in DRAFTS:
        yield Attack("stores", f"draft {draft[:40]!a}", lambda ground, d=draft: _changed(
            ground, lambda store: store.execute("UPDATE annotate_programs SET draft = ?", (d,))))  # fmt: skip
    for data in DONE:
        yield Attack("stores", f"event {data[:40]!a}", lambda ground, d=data: _changed(
            ground, lambda store: store.execute("UPDATE study_events SET data = ? WHERE kind = 'did'", (d,))
        ))  # fmt: skip
    for text in TEXTS_OF_PEOPLE:
        yield Attack("stores", f"handed in {text[:40]!a}", lambda ground, t=text: _handed_in(ground, t))
    for statements in SCHEMAS:
        yield Attack("stores", statements[:60], lambda ground, s=statements: _changed(
            ground, lambda store: store.executescript(s)))  # fmt: skip
    for kind in ("nothing", "text", "cut", "pipe", "link", "folder", "films: link", "films: name"):
        yield Attack("stores", f"a store that is {kind}", lambda ground, k=kind: _other(ground, k))


DRAFTS = (
    "{}", '{"rooms": [], "props": {}, "steps": []}', '{"rooms": {}, "props": {}, "steps": [{}]}',
    '{"rooms": {"x": 1e300}, "props": {}, "steps": []}', '{"rooms": {}, "props": {}, "steps": [{"special": 7}]}',
    '{"rooms": {}, "props": {}, "steps": [{"action": 7, "things": []}]}',
    '{"rooms": {}, "props": {}, "steps": [{"action": "Lie", "things": [["bed"]]}]}',
    '{"rooms": {}, "props": {}, "steps": [{"action": "Lie", "things": [["bed", 1, 2, 3, 4]]}]}',
    '{"rooms": {}, "props": {}, "steps": [{"action": "Lie", "things": [[7, []]]}]}',
    '{"rooms": {}, "props": {}, "steps": [{"special": "x>\\n[Walk] <bed> (1)"}]}',
)  # fmt: skip
DONE = (
    '{"item": 0, "condition": "written", "repeat": 0}', '{"item": 99, "condition": "x", "repeat": 0, "seconds": 1}',
    '{"item": 0, "condition": [], "repeat": 0, "seconds": 1}', '{"item": "0", "condition": "a", "repeat": 0}',
    '{"item": 0, "condition": "written", "repeat": 0, "seconds": "x", "record": {"metrics": 1}}',
)  # fmt: skip
TEXTS_OF_PEOPLE = (
    "<script>alert(1)</script>", '=HYPERLINK("http://x","y")', "=cmd|' /C calc'!A0", "@x", "\x1b]0;a\x07", "a\r\nb,c",
    '"', '"\n"', "\u202e", "x" * 300_000, "HITId,WorkerId", "\ud7ff", "%s%n", "../../guard/x",
)  # fmt: skip
SCHEMAS = (
    "DROP TABLE study_events", "DROP TABLE annotate_marks", "ALTER TABLE study_events RENAME COLUMN data TO other",
    "DROP TABLE study_places; CREATE VIEW study_places AS SELECT 1 AS study",
    "CREATE TRIGGER t AFTER DELETE ON sessions BEGIN INSERT INTO study_studies VALUES ('x', 'y', 'z'); END",
    "CREATE TRIGGER t BEFORE DELETE ON sessions BEGIN SELECT RAISE(ABORT, 'no'); END",
    "CREATE TRIGGER t BEFORE DELETE ON sessions BEGIN SELECT load_extension('{guard}/x'); END",
    "DELETE FROM study_studies", "DELETE FROM sessions",
    "DELETE FROM study_studies; INSERT INTO study_studies VALUES ('../../guard', 'name: x', 'z')",
    "DROP TABLE study_events; CREATE VIEW study_events AS WITH RECURSIVE n(number) AS (SELECT 0 UNION ALL SELECT "
    "number + 1 FROM n) SELECT 'judging' AS study, 'x' AS session, number, 'did' AS kind, 0 AS at, '{}' AS data FROM n",
)  # fmt: skip
"""Statements for a store's file that holds other things than our tables; the last view has no end."""


def _copy(ground: Ground) -> Path:
    return Path(shutil.copytree(served()[1], ground.folder / "collected"))


def _changed(ground: Ground, change: Callable[[sqlite3.Connection], Any]) -> Any:
    out = _copy(ground)
    store = sqlite3.connect(embedded(out))
    change(store)
    store.commit()
    store.close()
    return used(out)


def _handed_in(ground: Ground, text: str) -> Any:
    def change(store: sqlite3.Connection) -> None:
        store.execute("UPDATE annotate_texts SET title = ?, description = ?", (text, text))
        film = json.dumps({"title": text, "description": text, "program": text})
        store.execute("UPDATE annotate_marks SET value = ? WHERE kind = 'film'", (film,))

    found = _changed(ground, change)
    cells = (ground.folder / "collected/files/ratings.csv").read_text("utf-8").splitlines()
    assert not any(cell.startswith(("=", "@", '"=', '"@')) for line in cells for cell in line.split(",")), cells
    return found


def _other(ground: Ground, kind: str) -> Any:
    out = _copy(ground)
    path = embedded(out)
    data = path.read_bytes()
    films = out / FOLDER / "judging" / FILMS
    if kind == "films: link":
        films.unlink()
        films.symlink_to(ground.guard / "secret.csv")
        return used(out)
    if kind == "films: name":
        films.write_text(films.read_text().replace("000-a", "../../../guard/x"))
        return used(out)
    for each in path.parent.iterdir():
        each.unlink()
    if kind == "pipe":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    elif kind == "link":
        other = ground.guard / "other.sqlite"
        sqlite3.connect(other).close()
        other.touch()
        path.symlink_to(other)
        try:
            return opened_store(out, "", "", default)
        finally:
            assert not other.stat().st_size, "it was written to"
            other.unlink()
    else:
        path.write_bytes({"nothing": b"", "text": b"SQLite format 3\0" + b"x" * 9_000, "cut": data[:5_000]}[kind])
    return used(out)
