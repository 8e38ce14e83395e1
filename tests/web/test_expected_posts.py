"""Posts of a study that come too early, too late or twice change nothing: pages say so, and programs are refused."""

from __future__ import annotations

import pytest
from web.test_study_room import at_trial, finish, judging, ledger_of, playing  # noqa: F401

from hearth.studies.study import JUDGE, PLAY
from hearth.studies.study_progress import STAGES
from hearth.web.phrases import phrases
from hearth.web.study.expected_posts import TURNS
from hearth.web.study.study_store import StoreLedger

BROWSER = {"accept": "text/html,application/xhtml+xml,*/*;q=0.8"}
UNASKED = "You have done this already, perhaps in another tab: what you sent last has changed nothing. "


def events(server):
    ledger = ledger_of(server).ledger
    return [(each.kind, each.number) for person in ledger.streams() for each in ledger.read(person)]


def line(person, post, **data):
    """Return the message of the page to which a browser is led; the page has none once it is asked for anew."""
    answer = person.post(f"/study/{post}", data=data, headers=BROWSER)
    assert answer.status_code == 303, answer.text
    page = person.get(answer.headers["location"], headers=BROWSER)
    assert page.status_code == 200 and UNASKED not in person.get("/study/", headers=BROWSER).text
    assert page.text.count('role="alert"') == 1
    return page.text.split(UNASKED)[1].split("</p>")[0]


def refusal(person, post, accept="application/json", **data):
    """The error that a program gets."""
    answer = person.post(f"/study/{post}", data=data, headers={"accept": accept})
    assert answer.status_code == 409 and "location" not in answer.headers
    assert answer.json()["error"].pop("code") == "OUT_OF_ORDER"
    return tuple(answer.json()["error"][name] for name in ("place", "expected", "actual"))


def test_a_browser_is_led_to_where_its_person_is_and_sees_what_comes_first(playing):  # noqa: F811
    person = playing.person()
    for post in ("understood", "begin", "answer", "leave"):
        assert line(person, post) == "First you are asked whether you take part."
    person.post("/study/agree", data={"agree": "yes"})
    assert line(person, "answer") == "First read how it works."
    person.post("/study/understood")
    assert line(person, "understood") == "First do the practice."
    assert events(playing) == [("consented", 0), ("read", 1)]
    finish(playing, person)
    for post, data in (("agree", {"agree": "yes"}), ("answer", {"answer-helpful": "6"})):
        assert line(person, post, **data) == "First do this task: begin it, or go on with it."
    person.post("/study/leave")
    assert line(person, "begin") == "You have stopped taking part."


@pytest.mark.parametrize("accept", ["application/json", "*/*", ""])
def test_a_program_is_refused_with_the_stage(playing, accept):  # noqa: F811
    person = playing.person()
    at_trial(person)
    before = events(playing)
    assert refusal(person, "answer", accept, **{"answer-helpful": "6"}) == ("stage", "questions or exit", "practice")
    assert refusal(person, "understood", accept) == ("stage", "tutorial", "practice")
    assert refusal(person, "agree", accept, agree="yes") == ("stage", "consent", "practice")
    assert events(playing) == before


def test_who_has_not_agreed_is_nobody_to_a_program(playing):  # noqa: F811
    for post in ("understood", "begin", "answer", "leave"):
        answer = playing.person().post(f"/study/{post}")
        assert (answer.status_code, answer.json()["error"]["code"]) == (404, "UNKNOWN_ID"), post


def over(person):
    """The address of the game that comes, which is over then."""
    address = person.post("/study/begin").headers["location"]
    with person.websocket_connect(f"ws://127.0.0.1{address}/live") as link:
        for number, message in enumerate(({"type": "hello", "tab": "t"}, {"type": "finish"}), 1):
            link.send_json({**message, "n": number})
            link.receive_json()
    return address


def test_the_next_post_may_follow_a_game_at_once(playing):  # noqa: F811
    """The post itself looks up that a game is over; nobody has to ask for the page in between."""
    people = [playing.person() for _ in range(2)]
    for person in people:
        at_trial(person)
        address = over(person)
        if person is people[0]:
            assert refusal(person, "answer") == ("stage", "questions or exit", "trial"), "the practice is recorded"
        else:
            assert person.post("/study/begin").headers["location"] != address


def test_the_form_of_a_film_that_is_sent_twice_does_not_judge_the_next(judging):  # noqa: F811
    person = judging.person()
    person.post("/study/agree", data={"agree": "yes"})
    assert '<input type="hidden" name="trial" value="0">' in person.get("/study/").text
    first = {"trial": "0", "answer-quality": "4"}
    assert person.post("/study/answer", data=first).status_code == 303
    before = events(judging)
    assert refusal(person, "answer", **first) == ("trial", "1", "0")
    assert line(person, "answer", **first) == "Judge what is shown here now."
    assert refusal(person, "begin") == ("stage", "no stage of this study", "trial")
    assert events(judging) == before
    assert person.post("/study/answer", data={**first, "trial": "1"}).status_code == 303
    assert refusal(person, "answer", **{"answer-quality": "4"}) == ("answer", "comments", "quality")
    assert line(person, "answer", **first) == "These last questions are what is left to do."
    assert person.post("/study/answer", data={"trial": "2"}).status_code == 303
    assert refusal(person, "leave")[2] == "done" and line(person, "leave") == "You have finished the study."


def test_every_stage_has_its_line_and_every_post_its_stages():
    notes = {name.removeprefix("first_") for name in phrases()["study"] if name.startswith("first_")}
    assert notes == set(STAGES) - {"trial"} | {PLAY, JUDGE} and TURNS.keys() == {PLAY, JUDGE}
    assert all(set(stages) <= set(STAGES) for posts in TURNS.values() for stages in posts.values())


def test_answers_that_do_not_fit_are_a_page_for_browsers_and_data_for_programs(judging):  # noqa: F811
    person = judging.person()
    person.post("/study/agree", data={"agree": "yes"})
    for given, found in (("9", "9"), ("", "no answer")):
        wrong = {"answer-quality": given}
        page = person.post("/study/answer", data=wrong, headers=BROWSER)
        assert page.status_code == 400 and 'class="fault" role="alert">How well is it done? – ' in page.text
        answer = person.post("/study/answer", data=wrong)
        error = answer.json()["error"]
        assert answer.status_code == 400 and error["code"] == "BAD_ARGUMENT"
        assert (error["place"], error["actual"]) == ("answer-quality", found)


def test_what_came_second_at_the_same_moment_is_a_conflict(playing, monkeypatch):  # noqa: F811
    person = playing.person()
    person.post("/study/agree", data={"agree": "yes"})
    monkeypatch.setattr(StoreLedger, "append", lambda ledger, event: False)
    answer = person.post("/study/understood")
    assert (answer.status_code, answer.json()["error"]["code"]) == (409, "CONFLICT")
