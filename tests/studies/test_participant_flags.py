"""Signs that a person took part without care: each is found, and a careful person has none."""

from __future__ import annotations

import pytest
from studies.small import SMALL

from hearth.schemas.diagnostics import HearthError
from hearth.studies.events import Event
from hearth.studies.participant_flags import FLAGS, flags, is_gibberish
from hearth.studies.study_file import study_of
from hearth.studies.study_progress import Standing

CHECKED = SMALL.replace("practice: 1", "practice: 1\nlimits: {least_seconds: 20}").replace(
    "exit:\n",
    "- {name: red, text: Choose 2 here., scale: {from: 1, to: 7}, correct: 2}\n"
    "- {name: why, text: Why?, required: false}\nexit:\n",
)
CAREFUL = (["Turnleft"] * 12, 60.0, {"helpful": 5, "red": 2, "why": "It brought the plates before I asked."})


def standing(*trials, came=None):
    """A person with these trials: what was done in each tick, the seconds, the answers."""
    events = [Event("p", 0, "consented", 0.0, {"came": came} if came else {})]
    for acts, seconds, answers in trials:
        record = {"actions": [[act] for act in acts]}
        events.append(Event("p", len(events), "did", 1.0, {"seconds": seconds, "record": record}))
        events.append(Event("p", len(events), "answered", 2.0, {"answers": answers}))
    return Standing("p", 0, "trial", len(trials), tuple(events))


def found(*trials, **more):
    others = more.pop("others", ())
    return flags(study_of(CHECKED, "s.yaml"), standing(*trials, **more), others)


def test_a_careful_person_has_no_flag():
    other = (["Turnleft"] * 12, 61.0, {"helpful": 4, "red": 2, "why": "Nobody came, and I did it alone."})
    assert found(CAREFUL, other) == ()


@pytest.mark.parametrize(
    ("flag", "acts", "seconds", "answers"),
    [
        ("attention", ["Turnleft"], 60.0, {"red": 3}), ("fast", ["Turnleft"], 19.0, {}), ("nothing", [], 60.0, {}),
        ("nothing", [None] * 3, 60.0, {}), ("idle", [None] * 56 + ["Turnleft"] * 4, 60.0, {}),
        ("gibberish", ["Turnleft"], 60.0, {"why": "asdf asdf asdf"}),
        ("gibberish", ["Turnleft"], 60.0, {"why": "sdfgh jklm qwrtz"}),
        ("gibberish", ["Turnleft"], 60.0, {"why": "😀 👍👍"}),
        ("long", ["Turnleft"], 60.0, {"why": "It was the best of times, it was the worst of times. " * 30}),
    ],
)  # fmt: skip
def test_each_sign_is_found(flag, acts, seconds, answers):
    assert found((acts, seconds, answers)) == (flag,)


def test_signs_over_several_trials():
    assert found(*[(["Turnleft"], 60.0, {"helpful": 4})] * 4) == ("same",)
    assert found(*[(["Turnleft"], 60.0, {"why": "It was very helpful."})] * 2) == ("repeated",)
    assert found(CAREFUL, came={"person": "p1", "PROLIFIC_PID": "p1"}, others=["p2", "p1"]) == ("twice",)
    assert found(CAREFUL, came={"person": "p1"}, others=["p2"]) == ()
    signs = {"attention", "fast", "nothing", "idle", "same", "repeated", "gibberish", "long", "reopened", "twice"}
    assert set(FLAGS) == signs


@pytest.mark.parametrize(("opened", "expected"), [(1, ()), (3, ()), (4, ("reopened",))])
def test_a_page_that_is_opened_again_and_again_is_a_sign(opened, expected):
    person = standing(CAREFUL)
    did = next(each for each in person.events if each.kind == "did")
    did.data["opened"] = opened
    assert flags(study_of(CHECKED, "s.yaml"), person) == expected


@pytest.mark.parametrize(
    "text",
    ["", "ok", "No.", "Watch TV", "Sehr gut", "すごく良かった", "не знаю", "12345", "It is ok :-)", "Good 👍", "–"],
)
def test_short_and_foreign_words_are_no_gibberish(text):
    assert not is_gibberish(text)


@pytest.mark.parametrize("correct", ["8", "red", "2.5", "true"])
def test_a_right_answer_is_one_of_the_question(correct):
    with pytest.raises(HearthError, match="correct"):
        study_of(CHECKED.replace("correct: 2", f"correct: {correct}"), "s.yaml")
