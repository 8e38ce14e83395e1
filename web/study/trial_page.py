"""The desk's page of a trial: what was done tick by tick, with times, and the same in 3D on a timeline."""

from typing import Any

import orjson
from starlette.responses import Response

from hearth.schemas.failures import Code
from hearth.schemas.program import Step
from hearth.schemas.syntax import print_step
from hearth.simulation.world.home import Home
from hearth.studies.events import Event
from hearth.studies.study import PLAY
from hearth.studies.study_progress import Conduct
from hearth.studies.study_trials import record_of, tasks_of
from hearth.studies.trial_timeline import replay_data, timeline
from hearth.web.phrases import phrases, say
from hearth.web.play.game_messages import called
from hearth.web.room_request import Visit
from hearth.web.study.study_pages import conduct_here
from hearth.web.web_errors import WebError


def _found(visit: Visit) -> tuple[Conduct, str, int, Event]:
    """Return the study, the code of a person, and a trial of that person by its number, from 1.

    Raises:
        WebError: UNKNOWN_ID: there is none.
    """
    conduct = conduct_here(visit.web)
    code, given = visit.part("person"), visit.part("number")
    person = next((each for each in conduct.ledger.streams() if conduct.code(each) == code), "")
    did = [each for each in conduct.ledger.read(person) if each.kind == "did"] if person else []
    number = int(given) if given.isascii() and given.isdecimal() and len(given) < 5 else 0
    if conduct.study.room != PLAY or not 1 <= number <= len(did):
        raise WebError(Code.UNKNOWN_ID, "trial", "a trial that somebody played", f"{code} {given}"[:60])
    return conduct, code, number, did[number - 1]


def trial(visit: Visit) -> Response:
    """Return the page of a trial."""
    conduct, code, number, event = _found(visit)
    task, record = tasks_of(conduct.study)[event.data["item"]], record_of(event.data["record"])
    home, moments = timeline(task, record, event.data.get("times", ()), conduct.known())
    rows = [
        {
            "tick": each.tick + 1,
            "seconds": each.seconds,
            "shown": each.shown,
            "acts": [{"agent": act.agent, "said": _said(act.step, home), "failure": act.failure} for act in each.acts],
        }
        for each in moments
    ]
    return visit.page(
        "study/trial.html",
        study=conduct.study,
        code=code,
        number=number,
        task=task,
        condition=conduct.study.condition(event.data["condition"]),
        event=event.data,
        rows=rows,
    )


def _said(step: Step, home: Home) -> str:
    """Return an act in words, by the names that the person's page had."""
    if step.action not in phrases()["verbs"]:
        return print_step(step)
    names: list[Any] = [called(home)[home.index[ref.node]] for ref in step.objects if ref.node is not None]
    thing, place = [*names, "", ""][:2]
    return say("verbs", step.action, thing=thing, place=place)


def replay(visit: Visit) -> Response:
    """Return the trial for the browser's 3D player."""
    conduct, _, _, event = _found(visit)
    task, record = tasks_of(conduct.study)[event.data["item"]], record_of(event.data["record"])
    return Response(orjson.dumps(replay_data(task, record, conduct.known())), media_type="application/json")
