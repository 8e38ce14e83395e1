"""Annotating, by the addresses that pages use: both stages, check, run, review, marks, and the files for `build`."""

from __future__ import annotations

import json
import re

import pytest
import sqlalchemy as sql
from web.people import DESK, Server

import hearth
from hearth.web.annotate.descriptions import SCENES, lacks
from hearth.web.web_tables import SESSIONS

TEXT = {"title": "Watch TV", "description": "Sit down on the sofa, take the remote control and put the television on. "
        "Then watch until the film is over."}  # fmt: skip
ROOMS = {"living_room": 1}
PROPS = {"sofa": 1, "remote_control": 1, "television": 1}
STEPS = [
    {"action": "Walk", "things": [["living_room", 1]]},
    {"action": "Find", "things": [["remote_control", 1]]},
    {"action": "Grab", "things": [["remote_control", 1]]},
    {"action": "Find", "things": [["television", 1]]},
    {"action": "SwitchOn", "things": [["television", 1]]},
    {"action": "Walk", "things": [["sofa", 1]]},
    {"action": "Sit", "things": [["sofa", 1]]},
    {"action": "Watch", "things": [["television", 1]]},
]
RIGHT = {f"answer {number}": answer for number, answer in enumerate(["yes", "no"] * 3)}


def described(client, **changed) -> str:
    """Hand in a description; its id."""
    before = set(ids(client))
    answer = client.post("/annotate/describe", data={**TEXT, **changed})
    assert answer.status_code == 303, answer.text
    (new,) = set(ids(client)) - before
    return new


def ids(client) -> list[str]:
    return [part.split('"')[0] for part in client.get("/annotate/tasks").text.split('href="/annotate/task/')[1:]]


def scene(client, text, rooms=ROOMS, props=PROPS) -> None:
    for name, count in props.items():
        version = client.get(f"/annotate/task/{text}/work").json()["version"]
        kept = {f"prop {name}": client_count for name, client_count in counts(client, text).items()}
        data = {**{f"room {room}": number for room, number in rooms.items()}, **kept}
        data |= {"add": name, "quantity": count, "version": version}
        answer = client.post(f"/annotate/task/{text}/scene", data=data)
        assert answer.status_code == 303, answer.text


def counts(client, text) -> dict[str, int]:
    found: dict[str, int] = {}
    for thing in client.get(f"/annotate/task/{text}/work").json()["things"]:
        if not thing["room"]:
            found[thing["name"]] = found.get(thing["name"], 0) + 1
    return found


def submitted(client, text, steps=STEPS) -> None:
    scene(client, text)
    version = client.get(f"/annotate/task/{text}/work").json()["version"]
    answer = client.post(f"/annotate/task/{text}/submit", json={"version": version, "steps": steps})
    assert answer.status_code == 200, answer.text


def invited(server: Server, client):
    """A person, invited by the desk to review."""
    link = server.researcher().post("/desk/annotate/invite").text.split('value="')[1].split('"')[0]
    assert client.post(f"/annotate/reviewer/{link.rpartition('/')[2]}").status_code == 303
    return client


def reviewer(server: Server):
    client = invited(server, server.person())
    assert "You have passed" in client.get(client.post("/annotate/test", data=RIGHT).headers["location"]).text
    return client


def reviewer_of_own(server, person):
    person.post("/annotate/test", data=RIGHT)
    return invited(server, person)


def waiting(client) -> list[str]:
    page = client.get("/annotate/review").text
    return [part.split('"')[0] for part in page.split('href="/annotate/review/')[1:]]


def accept(client) -> str:
    (program,) = waiting(client)
    assert client.post(f"/annotate/review/{program}", data={"verdict": "accept"}).status_code == 303
    return program


@pytest.fixture
def text(person):
    return described(person)


@pytest.fixture
def set_up(person, text):
    scene(person, text)
    return text


def save(client, text, steps):
    version = client.get(f"/annotate/task/{text}/work").json()["version"]
    return client.post(f"/annotate/task/{text}/save", json={"version": version, "steps": steps})


def test_a_scene_is_drawn_and_a_short_description_is_answered_politely(person):
    page = person.get("/annotate/describe").text
    assert sum(f'<strong id="scene">{name}</strong>' in page for name in SCENES) == 1
    answer = person.post("/annotate/describe", data={"title": "TV", "description": "I watch <b>it</b>."})
    assert answer.status_code == 400
    assert "Please give the activity" in answer.text and "4 words so far" not in answer.text
    assert "3 words so far" in answer.text
    assert "I watch &lt;b&gt;it&lt;/b&gt;." in answer.text and "<b>it" not in answer.text


def test_all_eight_rooms_are_drawn(server):
    drawn = set()
    for _ in range(60):
        page = server.person().get("/annotate/describe").text
        drawn.add(page.split('<strong id="scene">')[1].split("<")[0])
    assert drawn == set(SCENES)


def test_what_is_no_activity_is_refused_as_ingest_would():
    assert lacks(TEXT["title"], TEXT["description"]) == ()
    assert lacks("Good survey", "Thank you for this nice survey, I liked the HIT very much, please pay me soon.")


def test_only_declared_things_and_only_what_the_grammar_affords(person, set_up):
    work = person.get(f"/annotate/task/{set_up}/work").json()
    assert [thing["name"] for thing in work["things"]] == [*ROOMS, *PROPS]
    by_name = {action["name"]: action for action in work["actions"]}
    fits = {thing["name"]: thing["fits"] for thing in work["things"]}
    assert by_name["Grab"]["slots"] == ["Grab 0"]
    assert "Grab 0" in fits["remote_control"] and "Grab 0" not in fits["sofa"]
    for step, code in (
        ({"action": "Grab", "things": [["sofa", 1]]}, "NOT_AFFORDED"),
        ({"action": "Grab", "things": [["shower", 1]]}, "UNDECLARED"),
        ({"action": "Sit", "things": [["sofa", 2]]}, "UNDECLARED"),
        ({"action": "Fly", "things": []}, "UNKNOWN_ACTION"),
        ({"action": "Grab", "things": []}, "WRONG_ARITY"),
        ({"action": "Grab"}, "WRONG_ARITY"),
        ({"special": "x" * 2_001}, "BAD_ARGUMENT"),
        (7, "UNKNOWN_ACTION"),
    ):
        answer = save(person, set_up, [step])
        assert answer.json()["error"]["code"] == code, (step, answer.text)
    assert person.get(f"/annotate/task/{set_up}/work").json()["steps"] == []


UNFIT = ("dance 💃", "a\n[Walk] <x> (1)", "x> (1)", "[Special] <x>", "x" * 300, "<", "\u2028[")


@pytest.mark.parametrize("words", UNFIT)
def test_a_special_block_that_can_not_stand_in_a_line_is_kept_and_is_a_fault(server, person, set_up, words):
    """All else is saved; it is handed in, run and written to files by nobody."""
    steps = [*STEPS, {"special": words}]
    answer = save(person, set_up, steps)
    assert answer.status_code == 200, answer.text
    faults = [(each["step"], each["code"]) for each in answer.json()["found"] if each["fault"]]
    assert faults == [(len(STEPS), "SYNTAX")]
    work = person.get(f"/annotate/task/{set_up}/work").json()
    assert work["steps"] == [*STEPS, {"special": " ".join(words.split())}]
    sent = {"version": work["version"], "steps": steps}
    assert person.post(f"/annotate/task/{set_up}/submit", json=sent).status_code == 400
    assert person.post(f"/annotate/task/{set_up}/run", json={"steps": steps, "home": "maple"}).status_code == 400
    assert save(person, set_up, STEPS).json()["found"] == save(person, set_up, STEPS).json()["found"]


def test_to_save_what_is_saved_takes_nothing_from_another_tab(person, set_up):
    version = save(person, set_up, STEPS).json()["version"]
    again = person.post(f"/annotate/task/{set_up}/save", json={"version": version - 1, "steps": STEPS})
    assert again.status_code == 200 and again.json()["version"] == version
    other = person.post(f"/annotate/task/{set_up}/save", json={"version": version - 1, "steps": STEPS[:-1]})
    assert other.json()["error"]["code"] == "LOCKED", "what changes something is still refused"
    assert person.get(f"/annotate/task/{set_up}/work").json()["steps"] == STEPS


def test_instances_are_distinguished(person, text):
    scene(person, text, props={"cup": 2, "kitchen_table": 1})
    things = person.get(f"/annotate/task/{text}/work").json()["things"]
    assert [thing["words"] for thing in things if thing["name"] == "cup"] == ["cup 1", "cup 2"]
    assert save(person, text, [{"action": "Grab", "things": [["cup", 2]]}]).status_code == 200


def test_an_unknown_thing_is_answered_with_names_that_are_near(person, text):
    answer = person.post(f"/annotate/task/{text}/scene", data={"add": "televison", "quantity": "1", "version": "1"})
    assert answer.status_code == 400 and "television" in answer.text.split('class="fault"')[1].split("</p>")[0]


def test_faults_stand_at_their_steps(person, set_up):
    steps = [
        STEPS[0],
        {"action": "Grab", "things": [None]},
        STEPS[6],
        STEPS[6],
        {"special": "dance a bit"},
        {"special": ""},
    ]
    found = save(person, set_up, steps).json()["found"]
    assert (1, True, "WRONG_ARITY") in [(each["step"], each["fault"], each["code"]) for each in found]
    assert (4, False, "SPECIAL_BLOCK") in [(each["step"], each["fault"], each["code"]) for each in found]
    assert (5, True, "EMPTY") in [(each["step"], each["fault"], each["code"]) for each in found]
    found = save(person, set_up, [STEPS[0], STEPS[4], STEPS[4]]).json()["found"]
    assert (2, True, "CONTRADICTION") in [(each["step"], each["fault"], each["code"]) for each in found]
    assert any(each["step"] == 1 and each["code"] == "NOT_CLOSE" for each in found)
    assert [each for each in save(person, set_up, STEPS).json()["found"] if each["fault"]] == []


def test_a_program_runs_in_a_home_step_by_step(person, set_up):
    answer = person.post(f"/annotate/task/{set_up}/run", json={"steps": STEPS, "home": "maple"}).json()
    assert answer["ran"] and len(answer["ticks"]) == len(STEPS)
    assert answer["ticks"][4]["changes"] == "The television is on"
    assert "The remote control is in the right hand" in answer["ticks"][2]["changes"]
    assert not any(re.search(r"[A-Z]{2}|\d", tick["changes"]) for tick in answer["ticks"]), "in everyday words"
    assert all(len(tick["at"]) == 3 for tick in answer["ticks"])
    assert person.get("/annotate/plan/maple").text.startswith("<svg")
    bad = person.post(f"/annotate/task/{set_up}/run", json={"steps": STEPS, "home": "../maple"})
    assert bad.json()["error"]["code"] == "UNKNOWN_HOME"
    faulty = person.post(f"/annotate/task/{set_up}/run", json={"steps": [], "home": "maple"})
    assert faulty.json()["error"]["code"] == "EMPTY"


def test_a_run_is_watched_in_3d(person, set_up):
    answer = person.post(f"/annotate/task/{set_up}/replay", json={"steps": STEPS, "home": "maple"}).json()
    assert len(answer["run"]["ticks"]) == len(STEPS) + 1
    home = person.get(answer["home"]).json()
    assert max(max(tick["off"], default=0) for tick in answer["run"]["ticks"]) < len(home["things"])
    assert person.get("/annotate/replay.js").text.count("HEARTH_REPLAY") > 0
    for home, code in (("../maple", "UNKNOWN_HOME"), (7, "BAD_ARGUMENT")):
        bad = person.post(f"/annotate/task/{set_up}/replay", json={"steps": STEPS, "home": home})
        assert bad.json()["error"]["code"] == code
    assert person.get("/annotate/shapes/nowhere").json()["error"]["code"] == "UNKNOWN_HOME"


def test_a_faulty_program_is_not_handed_in_and_an_old_tab_changes_nothing(person, set_up):
    work = person.get(f"/annotate/task/{set_up}/work").json()
    refused = person.post(f"/annotate/task/{set_up}/submit", json={"version": work["version"], "steps": []})
    assert refused.status_code == 400 and refused.json()["found"]
    first = {"version": work["version"], "steps": STEPS[:1]}
    assert person.post(f"/annotate/task/{set_up}/save", json=first).status_code == 200
    stale = person.post(f"/annotate/task/{set_up}/save", json={**first, "steps": STEPS[:2]})
    assert stale.status_code == 409 and stale.json()["error"]["code"] == "LOCKED"
    assert person.get(f"/annotate/task/{set_up}/work").json()["steps"] == STEPS[:1]


def test_one_session_reaches_nothing_of_another(server, person, set_up):
    assert save(person, set_up, STEPS).status_code == 200
    other = server.person()
    assert other.get(f"/annotate/task/{set_up}/work").json()["steps"] == []
    assert save(other, set_up, []).status_code == 200
    assert person.get(f"/annotate/task/{set_up}/work").json()["steps"] == STEPS
    nobody = server.client()
    for path in ("tasks", f"task/{set_up}", f"task/{set_up}/work", "review", "sketch", "rate", "film", "describe"):
        assert nobody.get(f"/annotate/{path}").status_code == 401
    assert person.get("/desk/annotate/").status_code == 403
    assert person.get("/desk/annotate/programs.csv").status_code == 403


def test_sketches_grades_and_their_files(server, person, text):
    submitted(person, text)
    second = reviewer(server)
    program = accept(second)
    assert program not in person.get("/annotate/sketch").text
    assert program in second.get("/annotate/sketch").text
    assert second.post(f"/annotate/sketch/{program}", data={}).json()["error"]["code"] == "BAD_ARGUMENT"
    assert second.post(f"/annotate/sketch/{program}", data={"keep 4": "yes", "keep 7": "yes"}).status_code == 303
    assert second.post(f"/annotate/rate/{program}", data={"grade": "4"}).json()["error"]["code"] == "BAD_ARGUMENT"
    assert second.post(f"/annotate/rate/{program}", data={"grade": "2"}).status_code == 303
    assert "Nothing is left" in second.get("/annotate/rate").text
    sketches = json.loads((server.out / "sketches.json").read_text())
    assert sketches["answer"] == [[0, 0, 0, 0, 1, 0, 0, 1]] and sketches["input"][0]["prefix"] == f"crowd:{program}"
    sheet = server.researcher().get("/desk/annotate/ratings.csv").text
    assert f"crowd:{program}" in sheet and sheet.rstrip().endswith(",2")


def test_the_desk_counts_the_texts_of_special_blocks(server, person, text):
    second = server.person()
    submitted(person, text, [*STEPS, {"special": "Do a  dance"}, {"special": "blow out the candles"}])
    submitted(second, text, [*STEPS, {"special": "do a dance"}])
    page = server.researcher().get("/desk/annotate/").text
    assert '<td>do a dance</td><td class="number">2</td><td>no</td>' in page
    assert server.client().get(f"/desk/enter/{DESK}").status_code == 303


def test_a_person_who_leaves_takes_everything_along_but_what_was_accepted(server, person, text):
    submitted(person, text)
    other = described(person, title="Go to sleep")
    submitted(person, other)
    second, who = reviewer(server), person.get("/mine").text.split("<strong>")[1].split("<")[0]
    program = waiting(second)[0]
    assert second.post(f"/annotate/review/{program}", data={"verdict": "accept"}).status_code == 303
    assert who in (server.out / "programs.csv").read_text()
    assert person.post("/mine/delete").status_code == 303
    assert [*ids(second)] == [text] and waiting(second) == []
    for file in server.out.glob("*.csv"):  # what `build` reads names them no more
        assert who not in file.read_text() and "Go to sleep" not in file.read_text()


def test_a_task_that_is_opened_twice_at_once_is_begun_once(server, person, text, monkeypatch):
    from hearth.web.annotate import annotated_programs

    owner = server.store.read(lambda connection: connection.execute(sql.select(SESSIONS.c.id)).scalars().first())
    first = annotated_programs.begin(server.store, owner, text)
    looks = iter((None, first))
    monkeypatch.setattr(annotated_programs, "own_program", lambda *_: next(looks))
    assert annotated_programs.begin(server.store, owner, text) == first


def test_what_was_accepted_builds_into_a_dataset_with_a_closed_ledger(server, person, text, build_folder, tmp_path):
    submitted(person, text)
    second = reviewer(server)
    program = accept(second)
    second.post(f"/annotate/sketch/{program}", data={"keep 4": "yes", "keep 7": "yes"})
    other = described(second, title="Go to sleep", description="I go to bed in the evening, I lie down on it and sleep "
                      "for eight hours until morning.")  # fmt: skip
    scene(second, other, rooms={"bedroom": 1}, props={"bed": 1})
    steps = [{"action": "Walk", "things": [["bedroom", 1]]}, {"action": "Walk", "things": [["bed", 1]]},
             {"action": "Lie", "things": [["bed", 1]]}, {"special": "sleep very deeply"}]  # fmt: skip
    version = second.get(f"/annotate/task/{other}/work").json()["version"]
    assert second.post(f"/annotate/task/{other}/submit", json={"version": version, "steps": steps}).status_code == 200
    accept(reviewer_of_own(server, person))
    made = build_folder(tmp_path / "built", [server.out], homes_folder="", homes=("maple",), variants=1).run_all()
    (name,) = {row["program_id"] for row in made.rows("sample")}
    assert name == f"crowd:{program}"
    assert (made.codes("ingest"), [code for _, code in made.codes("validate")]) == ([], ["SPECIAL_BLOCK"])
    dataset = hearth.load(made.out)
    stages = dataset.rows("SELECT records_in = records_through + records_rejected FROM ledger")[1]
    assert dataset[name].program.title == TEXT["title"] and "people" in {
        each["origin"] for each in dataset[name].sketches
    }
    assert len(stages) == 6 and all(closed for (closed,) in stages)
