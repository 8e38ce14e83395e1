"""Withdrawal erases each text on which nobody built, also where somebody looked at it."""

import pytest
import sqlalchemy as sql
from web.playing import session_of
from web.test_annotate import STEPS, TEXT, described, submitted
from web.test_strangers import built_on, in_files

from hearth.web.annotate.annotate_tables import PROGRAMS, TEXTS
from hearth.web.annotate.annotated_programs import EMPTY, begin

LOOKS = ("", "/scene", "/compose", "/work")


def rows(server, table):
    return server.store.rows(sql.select(table))


@pytest.mark.parametrize("look", LOOKS)
def test_a_look_at_a_description_stores_nothing_and_keeps_nothing(server, person, look):
    text, second = described(person), server.person()
    assert second.get(f"/annotate/task/{text}{look}").status_code in (200, 303)
    assert rows(server, PROGRAMS) == []
    person.post("/mine/delete")
    assert rows(server, TEXTS) == [] and in_files(server.out, TEXT["description"]) == []


def test_a_trial_run_and_an_unchanged_draft_keep_nothing(server, person):
    text, second = described(person), server.person()
    for path in ("run", "replay", "submit", "save"):
        second.post(f"/annotate/task/{text}/{path}", json={"version": 1, "steps": [], "home": "maple"})
    second.post(f"/annotate/task/{text}/scene", data={"version": "1"})
    assert all(row["draft"] == EMPTY for row in rows(server, PROGRAMS))
    person.post("/mine/delete")
    assert rows(server, TEXTS) == rows(server, PROGRAMS) == []


def test_an_empty_program_of_an_older_server_keeps_nothing(server, person):
    text, second = described(person), server.person()
    begin(server.store, session_of(server, second), text)
    person.post("/mine/delete")
    assert rows(server, TEXTS) == rows(server, PROGRAMS) == []


def test_a_kept_description_goes_with_the_last_person_who_built_on_it(server, person):
    text, builders = described(person), [server.person(), server.person()]
    for each in builders:
        each.post(f"/annotate/task/{text}/scene", data={"version": "1", "room living_room": "1"})
    person.post("/mine/delete")
    builders[0].post("/mine/delete")
    assert [row["id"] for row in rows(server, TEXTS)] == [text], "another person still builds on it"
    builders[1].post("/mine/delete")
    assert rows(server, TEXTS) == rows(server, PROGRAMS) == [] and in_files(server.out, TEXT["description"]) == []


def test_a_submitted_program_keeps_its_description_until_it_is_withdrawn_unless_it_was_accepted(server):
    first, second, _, text = built_on(server)
    first.post("/mine/delete")
    second.post("/mine/delete")
    assert [row["id"] for row in rows(server, TEXTS)] == [text], "an accepted program has its description"
    third, fourth = server.person(), server.person()
    waiting = described(third)
    submitted(fourth, waiting, STEPS)
    third.post("/mine/delete")
    assert {row["id"] for row in rows(server, TEXTS)} == {text, waiting}
    fourth.post("/mine/delete")
    assert [row["id"] for row in rows(server, TEXTS)] == [text]


def test_a_change_after_a_withdrawal_is_refused_with_a_reason(server, person):
    text, second = described(person), server.person()
    second.get(f"/annotate/task/{text}/scene")
    person.post("/mine/delete")
    answer = second.post(f"/annotate/task/{text}/scene", data={"version": "1", "room living_room": "1"})
    assert answer.json()["error"]["code"] == "UNKNOWN_ID"
