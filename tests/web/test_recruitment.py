"""People who come from a platform: their ids are kept from the first link on, and they are sent back at the end."""

from __future__ import annotations

import csv
import io
import re

import pytest
from web.people import Server
from web.test_study_room import JUDGE, judging, ledger_of  # noqa: F401

from hearth.schemas.diagnostics import HearthError
from hearth.studies.recruitment import Recruitment, platforms
from hearth.studies.study_file import study_of

COMPLETION = "https://app.prolific.com/submissions/complete?cc=C1A2B3"
LINK = "/study/?PROLIFIC_PID=5f3a&STUDY_ID=s1&SESSION_ID=x-2"
HTML = {"accept": "text/html"}


def recruited(text=JUDGE, platform="prolific", completion=COMPLETION):
    return f"{text}recruitment: {{platform: {platform}, completion: '{completion}'}}\n"


@pytest.fixture
def study(judging, tmp_path, knowledge):  # noqa: F811
    """The study of films, by way of Prolific."""
    (tmp_path / "study.yaml").write_text(recruited())
    judging.store.close()
    made = Server(tmp_path / "served", knowledge, study=tmp_path / "study.yaml")
    yield made
    made.store.close()


def came(server, link=LINK):
    """A newcomer's way from the platform's link to consent."""
    client = server.client()
    first = client.get(link, headers=HTML)
    assert first.status_code == 200, "a newcomer has done nothing wrong"
    to = re.search('name="to" value="([^"]*)"', first.text)[1].replace("&amp;", "&")
    there = client.post("/begin", data={"to": to}).headers["location"]
    page = client.get(there, headers=HTML).text
    hidden = dict(re.findall('<input type="hidden" name="([A-Z_]+)" value="([^"]*)">', page))
    return client, page, hidden


def test_a_person_comes_and_is_sent_back(study):
    client, page, hidden = came(study)
    assert hidden == {"PROLIFIC_PID": "5f3a", "STUDY_ID": "s1", "SESSION_ID": "x-2"}
    assert 'href="/annotate/"' not in page and "You take part in a study." in page
    assert client.post("/study/agree", data={"agree": "yes", **hidden}).status_code == 303
    for quality in ("4", "2"):
        client.post("/study/answer", data={"answer-quality": quality})
    client.post("/study/answer", data={})
    done = client.get("/study/").text
    assert f'href="{COMPLETION}"' in done
    code = re.search("Your code is <strong>(.+)</strong>", done)[1]
    desk = study.researcher()
    listed = desk.get("/desk/study/").text
    assert f"<code>{code}</code>" in listed and "<td>5f3a</td>" in listed
    paid = list(csv.DictReader(io.StringIO(desk.get("/desk/study/payments.csv").text)))
    assert [(each["code"], each["platform_id"], each["stage"]) for each in paid] == [(code, "5f3a", "done")]
    assert b"5f3a" not in desk.get("/desk/study/tables.zip").content, "tables have the code alone"
    desk.post("/desk/study/forget", data={"person": code})
    assert "5f3a" not in desk.get("/desk/study/payments.csv").text


def test_the_same_id_twice_is_flagged(study):
    for _ in range(2):
        client, _, hidden = came(study)
        client.post("/study/agree", data={"agree": "yes", **hidden})
    assert study.researcher().get("/desk/study/").text.count(">twice</span>") == 2


def test_people_who_come_otherwise_take_part_all_the_same(study):
    client, _, hidden = came(study, "/study/")
    assert hidden == {}
    client.post("/study/agree", data={"agree": "yes"})
    assert ledger_of(study).standing(ledger_of(study).ledger.streams()[0]).stage == "trial"


@pytest.mark.parametrize("given", ["%7B%7BPID%7D%7D", "a%20b", "x" * 101, "%3Cscript%3E"])
def test_a_damaged_link_says_so_and_nothing_of_it_is_kept(study, given):
    client, page, hidden = came(study, f"/study/?PROLIFIC_PID={given}")
    assert hidden == {} and "The link from Prolific is damaged" in page
    answer = client.post("/study/agree", data={"agree": "yes", "PROLIFIC_PID": "a b"})
    assert answer.status_code == 400 and ledger_of(study).ledger.streams() == []


def test_where_people_are_sent(study):
    came_by = {"PROLIFIC_PID": "a"}
    assert (
        Recruitment("prolific", "https://x.org/c?id={person}&c={code}").back(came_by, "k") == "https://x.org/c?id=a&c=k"
    )
    assert Recruitment("sona", "https://x.org/c?id={person}").back({}, "k") == "", "nobody is sent as somebody else"
    assert set(platforms()) == {"prolific", "mturk", "sona"}


@pytest.mark.parametrize(
    "completion", ["http://x.org/", "javascript:alert(1)", "https://x.org/{other}", "https://x.org/ a", "//x.org/", ""]
)
def test_an_address_of_completion_is_checked(completion):
    with pytest.raises(HearthError, match="completion"):
        study_of(recruited(completion=completion), "s.yaml")


def test_a_platform_that_is_not_known_is_refused():
    with pytest.raises(HearthError, match="platform"):
        study_of(recruited(platform="elsewhere"), "s.yaml")


def test_the_consent_page_that_is_lost_keeps_the_ids(study):
    client, _, hidden = came(study)
    page = client.get("/study/", headers=HTML).text
    assert dict(re.findall('<input type="hidden" name="([A-Z_]+)" value="([^"]*)">', page)) == hidden
    assert client.post("/study/agree", data={"agree": "yes"}).status_code == 303
    assert "5f3a" in study.researcher().get("/desk/study/payments.csv").text


def test_the_last_page_has_the_way_back_first_and_says_what_the_code_is_for(study):
    client, _, hidden = came(study)
    client.post("/study/agree", data={"agree": "yes", **hidden})
    for quality in ("4", "2"):
        client.post("/study/answer", data={"answer-quality": quality})
    client.post("/study/answer", data={})
    done = client.get("/study/").text
    assert done.index(COMPLETION) < done.index("Your code is") and "not a code of Prolific" in done
    mine = client.get("/mine").text
    assert "go back to the study" in mine and 'href="/study/"' in mine and "/annotate/mine" not in mine


def test_the_same_link_elsewhere_is_said_before_one_agrees(study):
    client, _, hidden = came(study)
    client.post("/study/agree", data={"agree": "yes", **hidden})
    assert "by your link already" in came(study)[1]
    assert "by your link already" not in came(study, LINK.replace("5f3a", "9a9a"))[1]


def test_declining_and_stopping_say_what_to_do_at_the_platform(study):
    client, page, hidden = came(study)
    assert 'href="/study/?no=yes"' in page
    declined = client.get("/study/?no=yes", headers=HTML).text
    assert "You do not take part" in declined and "At Prolific, give your place back" in declined
    client.post("/study/agree", data={"agree": "yes", **hidden})
    client.post("/study/leave")
    assert "At Prolific, give your place back" in client.get("/study/").text
