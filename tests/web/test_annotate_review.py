"""Reviews of annotated programs: a second person accepts, corrects or returns them, after a test."""

from __future__ import annotations

import csv
import io

from web.test_annotate import RIGHT, STEPS, TEXT, accept, reviewer, reviewer_of_own, save, submitted, text, waiting  # noqa: F401


def test_a_second_person_reviews_and_only_what_was_accepted_goes_out(server, person, text):  # noqa: F811
    submitted(person, text)
    assert save(person, text, STEPS[:1]).json()["error"]["code"] == "LOCKED"
    assert not (server.out / "programs.csv").exists()
    assert waiting(reviewer_of_own(server, person)) == []
    stranger = server.person()
    assert waiting(stranger) == []
    second = reviewer(server)
    (program,) = waiting(second)
    assert stranger.get(f"/annotate/review/{program}").json()["error"]["code"] == "NOT_ALLOWED"
    assert person.get(f"/annotate/review/{program}").json()["error"]["code"] == "UNKNOWN_ID"
    assert (
        second.post(f"/annotate/review/{program}", data={"verdict": "return"}).json()["error"]["code"] == "BAD_ARGUMENT"
    )
    note = {"verdict": "return", "note": "The <b>end</b> is missing"}
    assert second.post(f"/annotate/review/{program}", data=note).status_code == 303
    assert "The &lt;b&gt;end&lt;/b&gt; is missing" in person.get("/annotate/tasks").text
    submitted(person, text)
    accept(second)
    assert second.post(f"/annotate/review/{program}", data={"verdict": "accept"}).status_code == 404
    (row,) = csv.DictReader(io.StringIO((server.out / "programs.csv").read_text()))
    assert row["Answer.rooms"] == "living_room*1" and row["Input.description_id"] == text
    assert row["Answer.program"].splitlines()[2] == "[Grab] <remote_control> (1)"
    (answer,) = csv.DictReader(io.StringIO((server.out / "descriptions.csv").read_text()))
    assert answer["HITId"] == text and answer["Answer.description"] == TEXT["description"]


def test_a_mended_program_is_accepted_with_the_new_steps(server, person, text):  # noqa: F811
    submitted(person, text, STEPS[:-1])
    second = reviewer(server)
    (program,) = waiting(second)
    work = second.get(f"/annotate/review/{program}/work").json()
    assert work["steps"] == STEPS[:-1]
    checked = second.post(f"/annotate/review/{program}/save", json={"version": work["version"], "steps": STEPS})
    assert checked.json()["version"] == work["version"]
    assert second.get(f"/annotate/review/{program}/work").json()["steps"] == STEPS[:-1]
    ran = second.post(f"/annotate/review/{program}/run", json={"steps": STEPS, "home": "maple"})
    assert ran.json()["ran"]
    done = second.post(f"/annotate/review/{program}/submit", json={"version": work["version"], "steps": STEPS})
    assert done.json() == {"go": "/annotate/review"}
    assert "[Watch] <television> (1)" in (server.out / "programs.csv").read_text()


def test_the_test_is_failed_by_saying_yes_to_everything_and_taken_three_times_at_most(server):
    client = server.person()
    always = dict.fromkeys(RIGHT, "yes")
    for _ in range(3):
        assert "That is not enough" in client.get(client.post("/annotate/test", data=always).headers["location"]).text
    assert client.post("/annotate/test", data=RIGHT).status_code == 303
    assert waiting(client) == [] and "as often as one may" in client.get("/annotate/test").text


def test_a_test_that_is_loaded_or_sent_again_costs_one_try(server):
    client = server.person()
    assert "Tries" not in client.get("/annotate/test?given=yyyyyy").text, "answers are shown only after a try"
    always = {**dict.fromkeys(RIGHT, "yes"), "taken": "0"}
    result = client.post("/annotate/test", data=always).headers["location"]
    for _ in range(3):
        page = client.get(result).text
        assert "That is not enough" in page and "Tries that are left: 2" in page
        assert client.post("/annotate/test", data=always).headers["location"] == "/annotate/test"
    assert 'name="taken" value="1"' in client.get("/annotate/test").text
    passed = client.post("/annotate/test", data={**RIGHT, "taken": "1"}).headers["location"]
    assert "You have passed" in client.get(passed).text
