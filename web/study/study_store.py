"""A study's events in the server's store: the same that a file of a simulation has."""

import secrets
from collections.abc import Callable
from pathlib import Path
from typing import Any

import orjson
import sqlalchemy as sql
from sqlalchemy.exc import IntegrityError

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside
from hearth.studies.event_checks import check_events
from hearth.studies.events import PLACES, Event, salted
from hearth.studies.study import Study
from hearth.studies.study_file import study_of
from hearth.studies.study_folder import Collected
from hearth.studies.study_progress import Conduct
from hearth.web import play  # noqa: F401 - its tables are those of trials' games
from hearth.web.sessions import forget as forget_session
from hearth.web.store import Store, default_url, embedded, usable
from hearth.web.study.study_schema import HAPPENED, PLACES_TAKEN, STUDIES

FOLDER = "studies"
"""Folder of studies in the server's folder: their films, and the episodes of the human-like agent."""

UNREADABLE = "the store is not as `serve` keeps it"


class StoreLedger:
    """The events of a study in the store; see `studies.events.Ledger`."""

    def __init__(self, store: Store, study: str) -> None:
        self.store, self.study = store, study

    def streams(self) -> list[str]:
        """Return the people, in the order in which they joined."""
        query = sql.select(PLACES_TAKEN.c.session).where(PLACES_TAKEN.c.study == self.study)
        query = query.where(PLACES_TAKEN.c.session.is_not(None)).order_by(PLACES_TAKEN.c.number)
        return [str(each) for each in self.store.read(lambda connection: connection.execute(query).scalars().all())]

    def read(self, stream: str) -> list[Event]:
        """Return the events of a stream."""
        if stream == PLACES:
            return self._places()
        query = sql.select(HAPPENED).where(HAPPENED.c.study == self.study, HAPPENED.c.session == stream)
        rows = self.store.read(lambda connection: connection.execute(query.order_by(HAPPENED.c.number)).all())
        return [_event(stream, row.number, row.kind, row.at, row.data) for row in rows]

    def _places(self) -> list[Event]:
        query = sql.select(PLACES_TAKEN).where(PLACES_TAKEN.c.study == self.study).order_by(PLACES_TAKEN.c.number)
        rows = self.store.read(lambda connection: connection.execute(query).all())
        return [
            _event(PLACES, row.number, "joined", row.at, {"person": row.session or "", "place": row.place})
            for row in rows
        ]

    def append(self, event: Event) -> bool:
        """Keep an event; False if another has its number."""
        try:
            self.store.write(lambda connection: connection.execute(self._row(event)))
        except IntegrityError:
            return False
        return True

    def _row(self, event: Event) -> sql.Insert:
        if event.stream == PLACES:
            taken = {"place": event.data["place"], "session": event.data["person"]}
            return sql.insert(PLACES_TAKEN).values(study=self.study, number=event.number, at=event.at, **taken)
        data = orjson.dumps(event.data).decode()
        row = {"study": self.study, "session": event.stream, "number": event.number, "kind": event.kind}
        return sql.insert(HAPPENED).values(**row, at=event.at, data=data)

    def forget(self, stream: str) -> None:
        """Delete a person's session with all that belongs to it, in every room."""
        with usable("", UNREADABLE):
            forget_session(self.store, stream)

    def secret(self, name: str) -> str:
        """Return derived from the study's salt."""
        query = sql.select(STUDIES.c.salt).where(STUDIES.c.name == self.study)
        return salted(str(self.store.read(lambda connection: connection.execute(query).scalar_one())), name)


def _event(stream: str, number: Any, kind: Any, at: Any, data: Any) -> Event:
    """Return an event of a row, whose cells SQLite lets be of any kind.

    Raises:
        HearthError: BAD_JSON: it is not one.
    """
    try:
        given = data if isinstance(data, dict) else orjson.loads(data)
        return Event(stream, int(number), str(kind), float(at), given)
    except (orjson.JSONDecodeError, TypeError, ValueError, OverflowError) as error:
        raise HearthError.of(Code.BAD_JSON, f"event {str(number)[:20]} of `{stream[:20]}` is not one") from error


def conducted(store: Store, study: Study, known: Callable[[], Knowledge]) -> Conduct:
    """Return a study in the store, begun if it is new.

    Raises:
        HearthError: CONTRADICTION: it has begun with another file.
    """
    if not has_begun(store, study):
        row = {"name": study.name, "text": study.text, "salt": secrets.token_hex(16)}
        try:
            store.write(lambda connection: connection.execute(sql.insert(STUDIES).values(row)))
        except IntegrityError:  # another server began it
            return conducted(store, study, known)
    return Conduct(study, StoreLedger(store, study.name), known)


def has_begun(store: Store, study: Study) -> bool:
    """Return whether a study has begun in the store, with this very file.

    Raises:
        HearthError: CONTRADICTION: it has begun with another file.
    """
    query = sql.select(STUDIES.c.text).where(STUDIES.c.name == study.name)
    begun = store.read(lambda connection: connection.execute(query).scalar())
    if begun not in (None, study.text):
        message = f"the study `{study.name}` began with another file, and people take part in it"
        raise HearthError.of(Code.CONTRADICTION, message, suggestion="give the changed study another name")
    return begun is not None


def names_in(source: Path, url: str = "") -> list[str]:
    """Return the names of the studies of a store.

    Raises:
        HearthError: MISSING_FILE: there is none.
    """
    store = _store(source, url)
    query = sql.select(STUDIES.c.name).order_by(STUDIES.c.name)
    try:
        with usable(str(source), UNREADABLE):
            return store.read(lambda connection: list(map(str, connection.execute(query).scalars())))
    finally:
        store.close()


def opened_store(source: Path, url: str, name: str, known: Callable[[], Knowledge]) -> Collected:
    """Return a study that people took part in.

    Args:
        source: the server's folder.
        url: of the store, if it is not embedded there.
        name: of the study; may be empty where there is one.
        known: gives the knowledge.

    Raises:
        HearthError: MISSING_FILE; UNKNOWN_ID: it has no study of that name, or several where `name` is empty;
            BAD_JSON: an event does not belong to the study.
    """
    names = names_in(source, url)
    if (name or len(names) != 1) and name not in names:
        message = f"there is no study `{name[:60]}`" if name else f"there are {len(names)} studies"
        raise HearthError.of(Code.UNKNOWN_ID, message, file=str(source), suggestion=f"--study {' or '.join(names)}")
    store = _store(source, url)
    with usable(str(source), UNREADABLE):
        found = collected_in(store, name or names[0], source, known)
        check_events(found.study, found.conduct.slots, found.ledger, str(source))
    return found


def collected_in(store: Store, name: str, out: Path, known: Callable[[], Knowledge]) -> Collected:
    """Return a study of a store, with the folder of its films.

    Raises:
        HearthError: BAD_JSON: the store has another study by that name; every fault of the study.
    """
    query = sql.select(STUDIES.c.text).where(STUDIES.c.name == name)
    text = str(store.read(lambda connection: connection.execute(query).scalar()))
    study = study_of(text, f"{name}.yaml", begun=True)
    if study.name != name:
        raise HearthError.of(Code.BAD_JSON, f"the store has `{study.name}` as the study `{name[:60]}`", file=str(out))
    folder = inside(out, f"{FOLDER}/{name}")
    return Collected(conducted(store, study, known), False, folder)


def _store(source: Path, url: str) -> Store:
    if not url and not inside(source, embedded(Path()).as_posix()).is_file():
        message = "there are neither events of a simulation nor a server's store"
        raise HearthError.of(Code.MISSING_FILE, message, file=str(source), suggestion="name the folder, or --store URL")
    return Store(url or default_url(source))
