"""The desk of a study: places, deletions, the counts of people, tables and report."""

from __future__ import annotations

import io
import re
import zipfile

import pyarrow.parquet as pq
import pytest
import sqlalchemy as sql
from web.test_study_room import judging, ledger_of  # noqa: F401

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.web.study.study_schema import HAPPENED
from hearth.web.study.study_store import opened_store


def test_places_are_given_away_and_people_deleted(judging):  # noqa: F811
    clients = [judging.person() for _ in range(3)]
    for client in clients[:2]:
        client.post("/study/agree", data={"agree": "yes"})
    assert clients[2].post("/study/agree", data={"agree": "yes"}).status_code == 400
    clients[0].post("/study/leave")
    page = clients[0].get("/study/").text
    assert "stopped taking part" in page
    assert re.search("code: <strong>(.+)</strong>", page)[1] in judging.researcher().get("/desk/study/").text
    assert clients[2].post("/study/agree", data={"agree": "yes"}).status_code == 303
    desk = judging.researcher()
    page = desk.get("/desk/study/").text
    assert page.count("<tr><td><code>") == 3
    conduct = ledger_of(judging)
    people = conduct.ledger.streams()
    assert not any(person in page for person in people), "the desk shows the ids of the tables"
    assert desk.post("/desk/study/forget", data={"person": people[1]}).status_code == 303
    assert conduct.ledger.streams() == [people[0], people[2]]
    assert clients[1].get("/study/").status_code == 401, "the session is gone with it"
    assert "deleted" in desk.get("/desk/study/").text
    rows = judging.store.read(lambda c: c.execute(sql.select(HAPPENED)).all())
    assert people[1] not in str(rows)
    assert desk.post("/desk/study/dismiss", data={"person": people[2]}).status_code == 303
    assert conduct.standing(people[2]).stage == "left"
    assert clients[2].post("/mine/delete").status_code == 303
    assert conduct.ledger.streams() == [people[0]], "who deletes the session is deleted from the study"


def counted(server):
    """The figures of the desk: Finished, Under way, Silent, Left, Deleted."""
    page = server.researcher().get("/desk/study/").text
    return {name: int(re.search(rf"<dt>{name}</dt><dd>(\d+)", page)[1]) for name in FIGURES}


FIGURES = ("Finished", "Under way", "Silent", "Left", "Deleted")


def test_the_desk_counts_nobody_as_under_way_who_has_gone(judging):  # noqa: F811
    """By the page, by deletion, by silence; the page of the third has not been seen for longer than is allowed."""
    clients = [judging.person() for _ in range(2)]
    for client in clients:
        client.post("/study/agree", data={"agree": "yes"})
    assert counted(judging) == dict(zip(FIGURES, (0, 2, 0, 0, 0), strict=True))
    clients[0].post("/study/leave")
    assert counted(judging) == dict(zip(FIGURES, (0, 1, 0, 1, 0), strict=True))
    clients[0].post("/mine/delete")
    assert counted(judging) == dict(zip(FIGURES, (0, 1, 0, 0, 1), strict=True))
    judging.store.write(lambda c: c.execute(sql.update(HAPPENED).values(at=HAPPENED.c.at - 25 * 3600)))
    assert counted(judging) == dict(zip(FIGURES, (0, 0, 1, 0, 1), strict=True))
    assert "(silent)" in judging.researcher().get("/desk/study/").text


def test_a_full_study_says_so_before_it_asks_for_consent(judging):  # noqa: F811
    clients = [judging.person() for _ in range(3)]
    last = clients[2]
    assert "agree to take part" in last.get("/study/").text
    for client in clients[:2]:
        client.post("/study/agree", data={"agree": "yes"})
    page = last.get("/study/").text
    assert "places in this study are taken" in page and "/study/agree" not in page
    late = last.post("/study/agree", data={"agree": "yes"}, headers={"accept": "text/html"})
    assert late.status_code == 303 and late.headers["location"] == "/study/"
    clients[0].post("/study/leave")
    assert "agree to take part" in last.get("/study/").text


def test_the_desk_is_behind_its_token(judging):  # noqa: F811
    person = judging.person()
    for path in ("/desk/study/", "/desk/study/tables.zip", "/desk/study/report.html"):
        assert person.get(path).status_code == 403
        assert judging.client(headers={"authorization": "Bearer wrong"}).get(path).status_code == 403
    for path in ("/desk/study/forget", "/desk/study/dismiss"):
        assert person.post(path, data={"person": "x"}).status_code == 403
        assert judging.researcher().post(path, data={"person": "x"}).status_code == 404


def test_tables_and_report_are_downloaded(judging):  # noqa: F811
    person = judging.person()
    person.post("/study/agree", data={"agree": "yes"})
    person.post("/study/answer", data={"answer-quality": "4"})
    desk = judging.researcher()
    with zipfile.ZipFile(io.BytesIO(desk.get("/desk/study/tables.zip").content)) as packed:
        ratings = pq.read_table(io.BytesIO(packed.read("ratings.parquet"))).to_pylist()
        assert "study.yaml" in packed.namelist()
    assert [(row["question"], row["value"], row["simulated"]) for row in ratings] == [("quality", 4.0, False)]
    (name,) = ledger_of(judging).ledger.streams()
    assert ratings[0]["participant"] != name
    report = desk.get("/desk/study/report.html")
    assert "Judging" in report.text and "Simulated." not in report.text
    assert report.headers["content-disposition"].startswith("attachment")
    assert opened_store(judging.out, "", "", default).study.name == "judging"
    with pytest.raises(HearthError, match="no study `other`"):
        opened_store(judging.out, "", "other", default)
