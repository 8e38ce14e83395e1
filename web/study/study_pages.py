"""A person's way through a study: consent, tutorial, practice, trials or films, questions, exit."""

from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any
from urllib.parse import parse_qsl, urlencode

from starlette.responses import FileResponse, Response

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.names import inside
from hearth.studies.events import PLACES
from hearth.studies.films_to_judge import JudgedFilm, read_films
from hearth.studies.judged_film_recording import film_path
from hearth.studies.participant_flags import came as came_by
from hearth.studies.recruitment import is_id
from hearth.studies.study import FILM, JUDGE, MOST_TEXT, REPLAY, Question, Study
from hearth.studies.study_file import named
from hearth.studies.study_folder import FILMS
from hearth.studies.study_progress import (
    CONSENT,
    DONE,
    EXIT,
    LEFT,
    PRACTICE,
    QUESTIONS,
    TRIAL,
    TUTORIAL,
    Conduct,
    Standing,
)  # fmt: skip
from hearth.web import play
from hearth.web.phrases import say
from hearth.web.room_request import Visit, Web, by_browser
from hearth.web.sender_addresses import is_of_lab, sender_of
from hearth.web.study.expected_posts import UNASKED, check_answers, in_turn, unasked_line
from hearth.web.study.places_per_address import HELD, is_stranger
from hearth.web.study.study_store import FOLDER, conducted
from hearth.web.study.study_trial_games import begun, gone_on, is_begun
from hearth.web.web_errors import WebError

TEMPLATES = {
    TUTORIAL: "study/tutorial.html", PRACTICE: "study/begin.html", TRIAL: "study/begin.html",
    QUESTIONS: "study/questions.html", EXIT: "study/questions.html", DONE: "study/done.html", LEFT: "study/left.html",
}  # fmt: skip
"""The page of every stage; films have their own."""


CAME = "hearth_came"
"""The cookie with the ids of a platform's link; it goes when the browser is closed."""

ANSWER = "answer-"
"""Beginning of an answer's field; the name of its question follows."""

MEDIA = {FILM: "video/webm", REPLAY: "application/json"}
"""The type of a film's file, by how it is shown."""


def study_here(web: Web) -> Study | None:
    """Return the study that this server is for; None where it is for none."""
    if web.study is None:
        return None
    return _read(str(web.study), web.study.stat().st_mtime_ns if web.study.is_file() else 0)


@lru_cache(maxsize=4)
def _read(study: str, changed: int) -> Study:
    """Return a study's file, read again when it has changed."""
    return named(study)


def conduct_here(web: Web) -> Conduct:
    """Return the study of the server, as it goes on.

    Raises:
        WebError: MISSING_FILE: the server is for no study.
    """
    study = study_here(web)
    if study is None:
        raise WebError(Code.MISSING_FILE, "study", "a server that was started with `serve --study FILE`", "none")
    return conducted(web.store, study, lambda: web.known)


def way(visit: Visit) -> Response:
    """Return the page of where a person is."""
    if study_here(visit.web) is None:
        return visit.page("study/none.html")
    conduct = conduct_here(visit.web)
    standing = _here(visit, conduct)
    if standing is None and visit.fields.get("no") == "yes":
        return visit.page("study/declined.html", study=conduct.study)
    if standing is None and not conduct.has_room():
        return visit.page("study/full.html", study=conduct.study)
    if standing is None:
        return _consent_page(visit, conduct, _note(visit, conduct.study, None))
    return shown(visit, conduct, standing)


def _consent_page(visit: Visit, conduct: Conduct, note: str) -> Response:
    """Return the page that asks for consent; its form, and a cookie, keep what the link of a platform said.

    The cookie is for a person who loses this page: nothing is recorded before consent, and the ids are not lost.
    """
    study = conduct.study
    came = {} if study.recruitment is None else study.recruitment.came(visit.fields) or _kept(visit, study)
    if study.recruitment is not None and not all(map(is_id, came.values())):
        note, came = say("study", "link_damaged", platform=study.recruitment.title), {}
    if not note and came and study.recruitment is not None:
        person = came[study.recruitment.parameters[0]]
        note = say("study", "same_link") if _has_come(conduct, person, visit.person) else ""
    answer = visit.page("study/consent.html", study=study, note=note, came=came)
    if came:
        answer.set_cookie(CAME, urlencode(came), httponly=True, samesite="lax", secure=visit.web.secure, path="/study")
    return answer


def _kept(visit: Visit, study: Study) -> dict[str, str]:
    """Return what the link of a platform said when this browser opened it."""
    assert study.recruitment is not None
    return study.recruitment.came(dict(parse_qsl(visit.request.cookies.get(CAME, "")[:1_000])))


def _has_come(conduct: Conduct, came: str, person: str) -> bool:
    """Return whether another session takes part, or has, with an id of a platform."""
    others = (str(each.data["person"]) for each in conduct.ledger.read(PLACES) if each.data["person"] != person)
    return any(came_by(conduct.standing(other)).get("person") == came for other in others if other)


def _note(visit: Visit, study: Study, standing: Standing | None) -> str:
    """Return the page's note about a post that was not asked for and led here; "" where there was none."""
    return unasked_line(study, standing) if UNASKED in visit.fields else ""


def shown(
    visit: Visit, conduct: Conduct, standing: Standing, fault: str = "", given: Mapping[str, Any] | None = None
) -> Response:
    """Return the page of a stage; with the faults of the answers, if there are any."""
    study = conduct.study
    note = _note(visit, study, standing)
    values: dict[str, Any] = {
        "study": study,
        "standing": standing,
        "note": note,
        "fault": fault,
        "given": given or {},
        "total": len(conduct.slots[standing.place]),
        "most": MOST_TEXT,
        "code": conduct.code(standing.person),
        "back": "",
    }
    if study.recruitment is not None and standing.stage == DONE:
        values["back"] = study.recruitment.back(came_by(standing), values["code"])
    status = 400 if fault else 200
    if study.room == JUDGE and standing.stage in (TRIAL, QUESTIONS):
        film = film_at(visit.web, conduct, standing)
        planned = conduct.condition(standing)
        return visit.page("study/film.html", status, film=film, questions=study.asked(planned), **values)
    if standing.stage == CONSENT:
        return _consent_page(visit, conduct, note)
    helped = standing.stage in (TRIAL, QUESTIONS) and conduct.condition(standing).helped
    has_begun = standing.stage in (PRACTICE, TRIAL) and is_begun(visit.web, conduct, standing)
    values |= {"questions": conduct.questions(standing), "helped": helped, "started": has_begun}
    return visit.page(TEMPLATES[standing.stage], status, **values)


def _standing(conduct: Conduct, person: str) -> Standing | None:
    try:
        return conduct.standing(person)
    except HearthError:
        return None


def _here(visit: Visit, conduct: Conduct) -> Standing | None:
    """Return a person's stage, once a game that is over is recorded; None for a person who does not take part."""
    standing = _standing(conduct, visit.person)
    if standing is not None and standing.stage in (PRACTICE, TRIAL) and conduct.study.room != JUDGE:
        return gone_on(visit.web, conduct, standing)
    return standing


def takes_part(web: Web, person: str) -> bool:
    """Return whether a person takes part in the study of the server, or has."""
    return study_here(web) is not None and _standing(conduct_here(web), person) is not None


def agree(visit: Visit) -> Response:
    """Return a person agrees to take part, and gets a place."""
    conduct = conduct_here(visit.web)
    if visit.field("agree", 10) != "yes":
        raise WebError(Code.BAD_ARGUMENT, "agree", "that you agree, or nothing is begun", "no answer")
    if _standing(conduct, visit.person) is None and not conduct.has_room():
        raise WebError(Code.BAD_ARGUMENT, "place", "a free place in the study", "every place is taken", "/study/")
    came = _came(visit, conduct.study)
    in_turn(conduct.study, _joined(visit, conduct), "agree")
    conduct.consent(visit.person, came)
    return visit.go("/study/")


def _came(visit: Visit, study: Study) -> dict[str, str]:
    """Return what the link of a platform said, with the person's id there as `person`; empty for other people."""
    if study.recruitment is None:
        return {}
    found = study.recruitment.came({name: visit.field(name, 100) for name in study.recruitment.parameters})
    found = found or _kept(visit, study)
    if wrong := [name for name, given in found.items() if not is_id(given)]:
        raise WebError(Code.BAD_ARGUMENT, wrong[0], "an id of letters and digits", found[wrong[0]][:40])
    person, *_ = study.recruitment.parameters
    return {"person": found[person], **found} if found else {}


def _joined(visit: Visit, conduct: Conduct) -> Standing:
    """Return where a person is who has a place, or gets one.

    Raises:
        WebError: TOO_FAST: others of the same address hold as many places as it may.
    """
    address = sender_of(visit.request)
    known = is_of_lab(address, visit.web.lab) or not is_stranger(address, visit.web.secure)
    if known or _standing(conduct, visit.person) is not None:
        return conduct.join(visit.person)

    def under_way(person: str) -> bool:
        standing = _standing(conduct, person)
        return standing is not None and standing.stage not in (DONE, LEFT) and not conduct.is_silent(standing)

    HELD.check(conduct.study.name, address, len(conduct.slots), under_way)
    joined = conduct.join(visit.person)
    HELD.add(conduct.study.name, address, visit.person)
    return joined


def understood(visit: Visit) -> Response:
    """Return a person has read the tutorial."""
    conduct = conduct_here(visit.web)
    in_turn(conduct.study, _here(visit, conduct), "understood")
    conduct.read(visit.person)
    return visit.go("/study/")


def begin(visit: Visit) -> Response:
    """Begin a trial or a practice, or go on with it."""
    conduct = conduct_here(visit.web)
    standing = in_turn(conduct.study, _here(visit, conduct), "begin")
    return visit.go(play.trial_address(begun(visit.web, conduct, standing)))


def answer(visit: Visit) -> Response:
    """Answers to the questions of now; those about a film are also the word that it was watched.

    Raises:
        WebError: those of `in_turn` and `check_answers`; BAD_ARGUMENT: an answer of a program is not of its question.
    """
    conduct = conduct_here(visit.web)
    standing = in_turn(conduct.study, _here(visit, conduct), "answer")
    judged = standing.stage == TRIAL
    asked = conduct.study.asked(conduct.condition(standing)) if judged else conduct.questions(standing)
    answered = [name.removeprefix(ANSWER) for name in visit.fields if name.startswith(ANSWER)]
    check_answers(standing, [each.name for each in asked], answered, visit.field("trial", 10))
    given = {each.name: _given(visit, each) for each in asked}
    faults = [(each, fault) for each in asked if (fault := each.fault(given[each.name]))]
    if faults and not by_browser(visit.request):
        name, fault = faults[0][0].name, faults[0][1]
        raise WebError(Code.BAD_ARGUMENT, ANSWER + name, fault, str(given[name] or "no answer")[:40])
    if faults:
        lines = [say("study", "answer_fault", question=each.text, fault=fault) for each, fault in faults]
        return shown(visit, conduct, standing, "; ".join(lines), given)
    if judged:
        since = conduct.clock() - max(each.at for each in standing.events)
        conduct.watched(visit.person, round(since, 1))
    conduct.answer(visit.person, {name: each for name, each in given.items() if each is not None})
    return visit.go("/study/")


def _given(visit: Visit, question: Question) -> Any:
    """Return the answer to a question that came with the form; None if there is none."""
    text = visit.field(ANSWER + question.name, MOST_TEXT + 1).strip()
    if question.kind == "scale" and text.isascii() and text.isdigit() and len(text) < 4:
        return int(text)
    return text or None


def leave(visit: Visit) -> Response:
    """Let a person leave the study; their data is kept, and the place goes to another person."""
    conduct = conduct_here(visit.web)
    in_turn(conduct.study, _standing(conduct, visit.person), "leave")
    conduct.leave(visit.person)
    return visit.go("/study/")


def film(visit: Visit) -> Response:
    """Return the film that is judged now, or its replay in 3D. Its address does not say whose it is."""
    conduct = conduct_here(visit.web)
    standing = conduct.standing(visit.person)
    if standing.stage not in (TRIAL, QUESTIONS) or visit.part("number") != str(standing.number):
        raise WebError(Code.UNKNOWN_ID, "film", "the film that is to be judged now", visit.part("number")[:20])
    films = conduct.study.films
    if films is None:
        raise WebError(Code.UNKNOWN_ID, "film", "a study that judges films", conduct.study.name)
    path = film_path(_folder(visit.web, conduct.study), film_at(visit.web, conduct, standing), films.shown)
    if not path.is_file():
        raise WebError(Code.MISSING_FILE, "film", f"`study prepare {conduct.study.name}`", "no film")
    return FileResponse(path, media_type=MEDIA[films.shown], headers={"Cache-Control": "private, no-store"})


def film_at(web: Web, conduct: Conduct, standing: Standing) -> JudgedFilm:
    """Return the film that is judged in a trial.

    Raises:
        WebError: MISSING_FILE: its film was not prepared.
        HearthError: as of `read_films`.
    """
    planned = conduct.trial(standing)
    films = read_films(_folder(web, conduct.study) / FILMS)
    found = next((each for each in films if (each.item, each.condition) == (planned.item, planned.condition)), None)
    if found is None:
        raise WebError(Code.MISSING_FILE, "film", f"`study prepare {conduct.study.name}`", "no film of this trial")
    return found


def _folder(web: Web, study: Study) -> Path:
    return inside(web.out, f"{FOLDER}/{study.name}")
