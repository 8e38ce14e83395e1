"""The room Study: a person's way through, films that are judged, the desk; the same events as simulations have."""

from __future__ import annotations

import io
import re
import sqlite3
import time
import zipfile
from dataclasses import asdict

import pyarrow.parquet as pq
import pytest
import sqlalchemy as sql
from studies.small import SMALL
from typer.testing import CliRunner
from web.people import Server

from hearth import cli
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.storage.files import write_json
from hearth.studies.films_to_judge import JudgedFilm
from hearth.studies.simulated_people import simulated_person
from hearth.studies.study_file import study_of
from hearth.studies.study_progress import Conduct
from hearth.studies.study_simulation import Ahead, play_ahead
from hearth.studies.study_trials import tasks_of
from hearth.web.play.game_tables import GAMES
from hearth.web.store import default_url, embedded
from hearth.web.study.study_schema import PLACES_TAKEN, TRIAL_GAMES
from hearth.web.study.study_store import StoreLedger, conducted, opened_store
from hearth.web.web_tables import SESSIONS

JUDGE = """
name: judging
title: Judging
room: judge
seed: 1
people: 2
consent: You may stop at any time.
films:
  of: programs
  each: 1
  bands: [{name: a, title: good, from: 0.5, to: 1}, {name: b, title: bad, from: 0, to: 0.5}]
conditions: [{name: written, title: Written}]
repeats: 2
questions:
- {name: quality, text: How well is it done?, scale: {from: 1, to: 5}}
exit:
- {name: comments, text: What else?, required: false}
"""


@pytest.fixture
def playing(tmp_path, knowledge):
    (tmp_path / "study.yaml").write_text(SMALL)
    made = Server(tmp_path / "served", knowledge, study=tmp_path / "study.yaml")
    yield made
    made.store.close()


@pytest.fixture
def judging(tmp_path, knowledge):
    (tmp_path / "study.yaml").write_text(JUDGE)
    folder = tmp_path / "served" / "studies" / "judging"
    (folder / "films").mkdir(parents=True)
    films = [
        JudgedFilm(item, "written", f"{item:03d}-{band}", band, f"Title: Text {item} <b>", "maple", 1 - item, [])
        for item, band in enumerate("ab")
    ]
    write_json(folder / "films.json", [asdict(film) for film in films])
    for film in films:
        (folder / "films" / f"{film.name}.webm").write_bytes(b"film of " + film.group.encode())
    made = Server(tmp_path / "served", knowledge, study=tmp_path / "study.yaml")
    yield made
    made.store.close()


def ledger_of(server):
    return conducted(server.store, study_of(server_text(server), "study.yaml"), default)


def server_text(server):
    return (server.out.parent / "study.yaml").read_text()


def at_trial(client):
    client.post("/study/agree", data={"agree": "yes"})
    client.post("/study/understood")


def finish(server, client, acts=()):
    """Begin the game that is to come, do something in it, and finish it."""
    address = client.post("/study/begin").headers["location"]
    assert address.startswith("/play/game/")
    cookie = {"cookie": f"hearth={client.cookies['hearth']}"}
    with client.websocket_connect(f"ws://127.0.0.1{address}/live", headers=cookie) as link:
        link.send_json({"type": "hello", "n": 1, "tab": "t"})
        begun = link.receive_json()
        assert begun["helper"] in ("none", "somebody"), "which helper it is, people do not know"
        number = 2
        for tick, act in enumerate(acts):
            link.send_json({"type": "act", "n": number, "tick": tick, "act": act})
            answer = link.receive_json()
            assert answer["type"] == "tick", answer
            number += 1
        link.send_json({"type": "finish", "n": number})
        link.receive_json()
    assert client.get(f"{address}/episode.jsonl").status_code == 403
    assert address not in client.get("/play/").text
    return client.get("/study/").text


def spoken(text, home):
    """An instruction of a record as pages send it."""
    action, *nodes = (text or "wait").split(" ")
    return f"{action} {', '.join(f'{home.classes[home.index[int(node)]]} {node}' for node in nodes)}".strip()


def test_without_a_study_the_room_and_its_desk_say_so(server):
    assert "no study" in server.person().get("/study/").text
    assert "--study FILE" in server.researcher().get("/desk/study/").text
    assert server.person().post("/study/agree", data={"agree": "yes"}).status_code == 503


def test_nothing_is_recorded_before_one_agrees(playing):
    person = playing.person()
    assert "agree to take part" in person.get("/study/").text
    assert person.post("/study/agree").status_code == 400
    assert playing.store.read(lambda c: c.execute(sql.select(PLACES_TAKEN)).all()) == []


def test_a_person_goes_the_whole_way(playing):
    person = playing.person()
    at_trial(person)
    assert "<h1>Practice</h1>" in person.get("/study/").text
    page = finish(playing, person)
    conduct = ledger_of(playing)
    (name,) = conduct.ledger.streams()
    for _ in range(2):
        standing = conduct.standing(name)
        planned = conduct.trial(standing)
        helped = conduct.condition(standing).helped
        assert f"Task {standing.number + 1} of 2" in page
        assert ("A helper is in the home" in page) is helped
        record = play_ahead(Ahead(conduct.study, planned, simulated_person(0, 0), default))
        home = tasks_of(conduct.study)[planned.item].start(default()).home
        page = finish(playing, person, [spoken(tick[0], home) for tick in record["actions"]][:6])
        if helped:
            assert "How helpful was it?" in page and "hurting" in page
            assert person.post("/study/answer", data={"answer-helpful": "9"}).status_code == 400
            assert person.post("/study/answer", data={}).status_code == 400
            assert person.post("/study/answer", data={"answer-helpful": "6"}).status_code == 303
            page = person.get("/study/").text
    assert "Last questions" in page
    assert person.post("/study/answer", data={"answer-age": "ancient"}).status_code == 400
    person.post("/study/answer", data={"answer-comments": "<script>"})
    page, desk = person.get("/study/").text, playing.researcher()
    assert "Thank you" in page and name not in page
    code = re.search("Your code is <strong>(.+)</strong>", page)[1]
    assert f"<code>{code}</code>" in desk.get("/desk/study/").text, "the desk knows people by the code they are given"
    for table in ("participants", "trials", "decisions", "ratings"):
        assert {row["participant"] for row in table_of(desk, table)} == {code}
    events = conduct.standing(name).events
    assert [each.kind for each in events].count("did") == 2
    assert events[-1].data == {"answers": {"comments": "<script>"}}
    did = [each.data["record"] for each in events if each.kind == "did"]
    assert all(len(each["actions"]) == 6 and each["end"]["agent"] == 0 for each in did)
    assert {each["helped"] for each in did} == {False, True}
    assert desk.post("/desk/study/forget", data={"person": code}).status_code == 303
    assert conduct.ledger.streams() == [], "who asks with the code is deleted"


def table_of(desk, name):
    with zipfile.ZipFile(io.BytesIO(desk.get("/desk/study/tables.zip").content)) as packed:
        return pq.read_table(io.BytesIO(packed.read(f"{name}.parquet"))).to_pylist()


def test_a_game_is_begun_once_and_gone_on_with(playing):
    person = playing.person()
    at_trial(person)
    address = person.post("/study/begin").headers["location"]
    assert person.post("/study/begin").headers["location"] == address
    assert "Practice" in person.get("/study/").text
    assert len(playing.store.read(lambda c: c.execute(sql.select(TRIAL_GAMES)).all())) == 1


def test_a_study_that_is_played_has_no_films(playing):
    person = playing.person()
    at_trial(person)
    assert person.get("/study/film/0").json()["error"]["code"] == "UNKNOWN_ID"


def test_a_game_that_takes_too_long_is_ended(playing):
    person = playing.person()
    at_trial(person)
    person.post("/study/begin")
    playing.store.write(lambda c: c.execute(sql.update(GAMES).values(created=GAMES.c.created - 21 * 60)))
    assert "Task 1 of 2" in person.get("/study/").text


def test_a_trial_lasts_until_its_end_and_has_the_times_of_its_decisions(playing, monkeypatch):
    """Not until the person leaves the last banner; the export has when each decided, began and ended."""
    person, desk = playing.person(), playing.researcher()
    at_trial(person)
    finish(playing, person)
    address = person.post("/study/begin").headers["location"]
    cookie = {"cookie": f"hearth={person.cookies['hearth']}"}
    with person.websocket_connect(f"ws://127.0.0.1{address}/live", headers=cookie) as link:
        link.send_json({"type": "hello", "n": 1, "tab": "t"})
        assert link.receive_json()["left"] > 19 * 60
        for tick in range(3):
            link.send_json({"type": "act", "n": tick + 2, "tick": tick, "act": "Turnleft"})
            link.receive_json()
        link.send_json({"type": "finish", "n": 5})
        over = link.receive_json()
    assert (over["end"], over["ended_by"]) == ("FINISHED", 0)
    playing.store.write(lambda c: c.execute(sql.update(GAMES).values(created=GAMES.c.created - 60)))
    later = time.time() + 300
    with monkeypatch.context() as patch:  # five minutes on the last banner
        patch.setattr("time.time", lambda: later)
        person.get("/study/")
    (row,) = table_of(desk, "trials")
    assert 60 <= row["seconds"] < 90 and row["end"] == "FINISHED"
    times = [each["seconds"] for each in table_of(desk, "decisions") if each["agent"] == 0]
    assert len(times) == 3 and 60 <= times[0] <= times[1] <= times[2] <= row["seconds"] + 0.1
    (who,) = table_of(desk, "participants")
    assert 0 < time.time() - who["began"] < 60 and who["ended"] is None
    person.post("/study/leave")
    (who,) = table_of(desk, "participants")
    assert who["began"] <= who["ended"]


def test_no_move_is_taken_once_the_time_of_a_trial_is_over(playing):
    person = playing.person()
    at_trial(person)
    finish(playing, person)
    address = person.post("/study/begin").headers["location"]
    playing.store.write(lambda c: c.execute(sql.update(GAMES).values(created=GAMES.c.created - 20 * 60)))
    cookie = {"cookie": f"hearth={person.cookies['hearth']}"}
    with person.websocket_connect(f"ws://127.0.0.1{address}/live", headers=cookie) as link:
        link.send_json({"type": "hello", "n": 1, "tab": "t"})
        begun = link.receive_json()
        assert (begun["over"], begun["end"], begun["left"]) == (True, "TIMED_OUT", 0)
        link.send_json({"type": "act", "n": 2, "tick": 0, "act": "Turnleft"})
        assert link.receive_json()["error"]["code"] == "NOT_ALLOWED"
    person.get("/study/")
    (row,) = table_of(playing.researcher(), "trials")
    assert (row["seconds"], row["ticks"], row["end"]) == (20 * 60, 0, "TIMED_OUT")


def test_one_answers_what_is_asked_and_nothing_else(playing):
    person = playing.person()
    assert person.post("/study/answer", data={"answer-helpful": "6"}).status_code == 404
    at_trial(person)
    for post in ("agree", "understood", "answer"):
        assert person.post(f"/study/{post}", data={"agree": "yes", "answer-helpful": "6"}).status_code == 409
    assert person.get("/study/film/0").status_code == 404


def test_films_are_judged_one_after_the_other(judging):
    person = judging.person()
    person.post("/study/agree", data={"agree": "yes"})
    conduct = ledger_of(judging)
    (name,) = conduct.ledger.streams()
    for number in range(2):
        page = person.get("/study/").text
        item = conduct.trial(conduct.standing(name)).item
        assert f"Film {number + 1} of 2" in page and f"Text {item} &lt;b&gt;" in page
        assert person.get(f"/study/film/{number}").content == b"film of " + b"ab"[item : item + 1]
        assert person.get(f"/study/film/{1 - number}").status_code == 404
        assert "000-" not in page and "001-" not in page, "the film's name says of which band it is"
        assert person.post("/study/answer", data={"answer-quality": "0"}).status_code == 400
        assert person.post("/study/answer", data={"answer-quality": "4"}).status_code == 303
    assert person.post("/study/answer", data={}).status_code == 303
    assert "Thank you" in person.get("/study/").text
    ratings = [each.data["answers"] for each in conduct.standing(name).events if each.kind == "answered"]
    assert ratings == [{"quality": 4}] * 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("UPDATE study_events SET data = 'x'", "is not one"),
        ("UPDATE study_events SET at = 'x'", "is not one"),
        ("UPDATE study_events SET data = '[]' WHERE kind = 'did'", "is not of this study"),
        ("UPDATE study_events SET kind = 'won'", "does not happen there"),
        ("UPDATE study_places SET place = 99", "there are"),
        ("UPDATE study_studies SET text = replace(text, 'name: judging', 'name: other')", "as the study `judging`"),
        ("ALTER TABLE study_events RENAME COLUMN data TO other", "`study_events` lacks `data`"),
        ("CREATE TRIGGER t AFTER DELETE ON sessions BEGIN DELETE FROM study_studies; END", "has a trigger"),
        ("DROP TABLE study_events; CREATE VIEW study_events AS SELECT 1 AS study", "has a view"),
    ],
)
def test_the_store_of_a_stranger_is_refused_where_no_server_wrote_it_so(judging, change, message):
    person = judging.person()
    person.post("/study/agree", data={"agree": "yes"})
    person.post("/study/answer", data={"answer-quality": "4"})
    judging.store.close()
    with sqlite3.connect(embedded(judging.out)) as store:
        store.execute("PRAGMA foreign_keys = OFF")
        store.executescript(change)
    store.close()
    with pytest.raises(HearthError, match=message):
        opened_store(judging.out, "", "", default)


def test_a_store_that_is_a_link_to_another_file_is_not_written_to(tmp_path):
    (tmp_path / "given/.server").mkdir(parents=True)
    other = tmp_path / "other.sqlite"
    other.touch()
    embedded(tmp_path / "given").symlink_to(other)
    with pytest.raises(HearthError, match="DAMAGED_FILE"):
        opened_store(tmp_path / "given", "", "", default)
    assert other.read_bytes() == b""


def test_a_folder_whose_own_folder_is_a_link_is_refused(tmp_path):
    (tmp_path / "other").mkdir()
    (tmp_path / "given").mkdir()
    (tmp_path / "given/.server").symlink_to(tmp_path / "other")
    with pytest.raises(HearthError, match="is a link"):
        default_url(tmp_path / "given")
    assert not list((tmp_path / "other").iterdir())


def test_a_study_that_has_begun_does_not_change(judging, tmp_path):
    judging.person().post("/study/agree", data={"agree": "yes"})
    (tmp_path / "study.yaml").write_text(JUDGE.replace("seed: 1", "seed: 2"))
    answer = judging.person().get("/study/", headers={"accept": "text/html"})
    assert answer.status_code == 400 and "was changed while people take part" in answer.text
    assert "began with another file" in judging.person().get("/study/").json()["error"]["actual"]


def test_a_server_does_not_start_with_a_study_that_began_otherwise(judging, tmp_path, monkeypatch):
    monkeypatch.setattr("hearth.web.serving.run", lambda *given: None)
    judging.person().post("/study/agree", data={"agree": "yes"})
    (tmp_path / "study.yaml").write_text(JUDGE.replace("seed: 1", "seed: 2"))
    result = CliRunner().invoke(
        cli.app, ["serve", "--study", str(tmp_path / "study.yaml"), "--out", str(judging.out), "--port", "0"]
    )
    assert result.exit_code == 1 and "began with another file" in result.output, result.output


def test_two_who_join_at_once_get_two_places(judging):
    """The second finds its number taken, and asks again."""
    conduct = ledger_of(judging)
    people = [judging.person() for _ in range(2)]
    query = sql.select(SESSIONS.c.id).order_by(SESSIONS.c.created)
    ids = judging.store.read(lambda connection: connection.execute(query).scalars().all())

    class Late(StoreLedger):
        raced = False

        def append(self, event):
            if not Late.raced:
                Late.raced = True
                Conduct(conduct.study, StoreLedger(self.store, self.study), default).join(ids[1])
            return super().append(event)

    found = Conduct(conduct.study, Late(judging.store, "judging"), default).join(ids[0])
    assert {found.place, conduct.standing(ids[1]).place} == {0, 1}
    assert len(people) == 2
