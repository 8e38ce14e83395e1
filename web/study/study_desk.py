"""The desk of a study: how far people are, who has left, tables and report, deletion on request."""

import io
import time
from collections import Counter
from typing import Any

import sqlalchemy as sql
from starlette.responses import Response

from hearth.storage.csv_files import rows_writer
from hearth.studies.events import PLACES
from hearth.studies.participant_flags import FLAGS, came, flags
from hearth.studies.study_findings import findings
from hearth.studies.study_folder import Collected
from hearth.studies.study_progress import DONE, LEFT, Conduct
from hearth.studies.study_report import page
from hearth.studies.study_tables import archive, person_of
from hearth.web.room_request import Visit
from hearth.web.study.study_pages import conduct_here, study_here
from hearth.web.study.study_schema import STUDIES
from hearth.web.study.study_store import collected_in

SILENT, DELETED = "silent", "deleted"
OVER = (DONE, LEFT, SILENT, DELETED)
"""The states of people who have ended: also those silent for longer than the study allows, and deleted people."""


def overview(visit: Visit) -> Response:
    """Return the people of the study, and how far they are."""
    if study_here(visit.web) is None:
        return visit.page("study/desk_none.html")
    conduct = conduct_here(visit.web)
    people = list(_people(conduct))
    stages = Counter(SILENT if each["silent"] else each["stage"] for each in people)
    return visit.page(
        "study/desk.html",
        study=conduct.study,
        people=people,
        done=stages[DONE],
        left=stages[LEFT],
        silent=stages[SILENT],
        deleted=stages[DELETED],
        going=sum(count for stage, count in stages.items() if stage not in OVER),
        places=len(conduct.slots),
        meanings=FLAGS,
    )


def _people(conduct: Conduct) -> Any:
    now = conduct.clock()
    joined = conduct.ledger.read(PLACES)
    ids = {person: _platform_id(conduct, person) for event in joined if (person := event.data["person"])}
    for event in joined:
        person = event.data["person"]
        if not person:
            nothing = {"id": "", "why": "", "trials": 0, "of": 0, "last": "", "silent": False, "came": "", "flags": ()}
            yield {**nothing, "place": event.data["place"] + 1, "stage": DELETED}
            continue
        standing = conduct.standing(person)
        why = [str(each.data["why"]) for each in standing.events if each.kind == "left"]
        yield {
            "id": conduct.code(person),
            "place": standing.place + 1,
            "stage": standing.stage,
            "why": why[0] if why else "",
            "trials": sum(each.kind == "did" for each in standing.events),
            "of": len(conduct.slots[standing.place]),
            "minutes": round((conduct.last_sign(standing) - conduct.joined_at(person)) / 60, 1),
            "last": _ago(now - conduct.last_sign(standing)),
            "silent": conduct.is_silent(standing),
            "came": ids[person],
            "flags": flags(conduct.study, standing, [other for who, other in ids.items() if who != person and other]),
        }


def _platform_id(conduct: Conduct, person: str) -> str:
    return came(conduct.standing(person)).get("person", "")


def payments(visit: Visit) -> Response:
    """Return a table by which people are paid: the code, the id at the platform, how far they are, and the flags."""
    written = io.StringIO()
    write = rows_writer(written)
    write([("code", "platform_id", "stage", "trials", "minutes", "flags")])
    conduct = conduct_here(visit.web)
    people = [each for each in _people(conduct) if each["id"]]
    columns = ("id", "came", "stage", "trials", "minutes")
    write([*(each[name] for name in columns), " ".join(each["flags"])] for each in people)
    return _file(written.getvalue().encode(), "text/csv", f"{conduct.study.name}-payments.csv")


def _ago(seconds: float) -> str:
    minutes = int(seconds // 60)
    if minutes < 60:
        return f"{minutes} min ago"
    return f"{minutes // 60} h ago" if minutes < 2880 else f"{minutes // 1440} days ago"


def _collected(visit: Visit) -> Collected:
    return collected_in(visit.web.store, conduct_here(visit.web).study.name, visit.web.out, lambda: visit.web.known)


def tables(visit: Visit) -> Response:
    """Return the study's tables as an archive."""
    found = _collected(visit)
    return _file(archive(found), "application/zip", f"{found.study.name}.zip")


def report(visit: Visit) -> Response:
    """Return the study's report as a page to keep.

    It has a style of its own, which pages of this server may not have.
    """
    found = _collected(visit)
    names = visit.web.store.read(lambda connection: set(connection.execute(sql.select(STUDIES.c.name)).scalars()))
    other = found.study.alone
    alone = collected_in(visit.web.store, other, visit.web.out, found.conduct.known) if other in names else None
    written = page(findings(found, alone), []).encode()
    return _file(written, "text/html", f"{found.study.name}-{time.strftime('%Y-%m-%d')}.html")


def _file(data: bytes, kind: str, name: str) -> Response:
    return Response(data, media_type=kind, headers={"Content-Disposition": f'attachment; filename="{name}"'})


def forget(visit: Visit) -> Response:
    """Delete all that is known of a person, as the person asked."""
    found = _collected(visit)
    found.conduct.forget(person_of(found, visit.field("person", 100)))
    visit.web.written()
    return visit.go("/desk/study/")


def dismiss(visit: Visit) -> Response:
    """Count a person as having left, so that the place is given to another."""
    found = _collected(visit)
    found.conduct.leave(person_of(found, visit.field("person", 100)), "dismissed")
    return visit.go("/desk/study/")
