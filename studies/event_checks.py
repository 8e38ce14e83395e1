"""Events of a folder that a user gave: their form, and whether they are ways through its study."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from hearth.challenges.result_files import episode_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.studies.assignment import Planned, Slots
from hearth.studies.events import PLACES, Event, Ledger
from hearth.studies.recruitment import is_id
from hearth.studies.study import PLAY, Question, Study
from hearth.studies.study_trials import tasks_of

_TRIAL: dict[str, type | tuple[type, ...]] = {"item": int, "condition": str, "repeat": int}

_FIELDS: Mapping[str, Mapping[str, type | tuple[type, ...]]] = {
    "joined": {"person": str, "place": int},
    "consented": {},
    "read": {},
    "practised": {},
    "did": {**_TRIAL, "seconds": (int, float)},
    "answered": {**_TRIAL, "answers": dict},
    "left": {"why": str},
    "finished": {"answers": dict},
}
"""The data of every kind of event."""


_METRICS = {"success", "ticks", "length", "reward"}
"""The metrics in every record of an episode."""


def check_events(study: Study, slots: Slots, ledger: Ledger, file: str) -> None:
    """Refuse events that are not of this study.

    Raises:
        HearthError: BAD_JSON: an event lacks something, or is of another study, with its stream and number.
    """
    for event in ledger.read(PLACES):
        _check_form(event, ("joined",), file)
        if not 0 <= event.data["place"] < len(slots):
            raise _wrong(event, f"there are {len(slots)} places", file)
    places = {each.data["person"]: each.data["place"] for each in ledger.read(PLACES)}
    for person in ledger.streams():
        events = ledger.read(person)
        if person not in places:
            raise _wrong(events[0], "nobody of that id joined", file)
        _check_way(study, slots[places[person]], events, file)


def _check_way(study: Study, slot: Sequence[Planned], events: Sequence[Event], file: str) -> None:
    done = 0
    for event in events:
        _check_form(event, tuple(kind for kind in _FIELDS if kind != "joined"), file)
        if event.kind in ("did", "answered"):
            done += event.kind == "did"
            if not 0 < done <= len(slot) or _named(event) != slot[done - 1]:
                raise _wrong(event, "it is not the trial that comes there", file)
        if event.kind == "consented":
            _check_came(event, file)
        if event.kind == "did" and study.room == PLAY:
            _check_record(study, event, file)
        if event.kind in ("answered", "finished"):
            asked = study.exit if event.kind == "finished" else study.asked(study.condition(event.data["condition"]))
            _check_answers(asked, event, file)


def _check_form(event: Event, kinds: Sequence[str], file: str) -> None:
    if event.kind not in kinds:
        raise _wrong(event, f"`{event.kind[:20]}` does not happen there", file)
    if not isinstance(event.data, dict) or not math.isfinite(event.at):
        raise _wrong(event, "it has no data or no time", file)
    for name, kind in _FIELDS[event.kind].items():
        value = event.data.get(name)
        if not isinstance(value, kind) or isinstance(value, bool):
            raise _wrong(event, f"`{name}` is {str(value)[:20]}", file)


def _check_came(event: Event, file: str) -> None:
    came = event.data.get("came", {})
    if not isinstance(came, dict) or not all(isinstance(each, str) and is_id(each) for each in came.values()):
        raise _wrong(event, "its platform gave no ids", file)


def _check_record(study: Study, event: Event, file: str) -> None:
    given = event.data.get("record")
    record = episode_of(given) if isinstance(given, dict) else None
    times = event.data.get("times", [])
    if not isinstance(times, list) or not all(type(each) in (int, float) and math.isfinite(each) for each in times):
        raise _wrong(event, "its times of decisions are none", file)
    if type(event.data.get("opened", 1)) is not int:
        raise _wrong(event, "its page was opened no number of times", file)
    if record is not None and not record.metrics.keys() >= _METRICS:
        raise _wrong(event, "its record has no metrics", file)
    if record is None or record.task != tasks_of(study)[event.data["item"]].id:
        raise _wrong(event, "it has no record of its task", file)
    if record.end is not None and not isinstance(record.end.get("code"), str):
        raise _wrong(event, "its episode ends without a reason", file)


def _check_answers(asked: Sequence[Question], event: Event, file: str) -> None:
    questions = {each.name: each for each in asked}
    for name, answer in event.data["answers"].items():
        if name not in questions or questions[name].fault(answer):
            raise _wrong(event, f"`{name[:20]}` is not an answer to a present question", file)


def _named(event: Event) -> Planned:
    return Planned(event.data["item"], event.data["condition"], event.data["repeat"])


def _wrong(event: Event, why: Any, file: str) -> HearthError:
    where = f"event {event.number} of `{event.stream[:20]}`"
    return HearthError.of(Code.BAD_JSON, f"{where} is not of this study: {why}", file=file)
