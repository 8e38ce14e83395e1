"""The desk's queue of programs, and thanks with the next description after a program was handed in."""

from __future__ import annotations

import re

from web.test_annotate import TEXT, accept, reviewer, submitted, text  # noqa: F401


def rows(server):
    page = server.researcher().get("/desk/annotate/").text
    return re.findall(r'<a href="(/desk/annotate/item/[^"]+)">(.*?)</a></td><td>(.*?)</td>(.*?)</tr>', page, re.DOTALL)


def described(client, description):
    client.post("/annotate/describe", data={**TEXT, "description": description})


def test_the_desk_reads_a_program_and_erases_it(server, person, text):  # noqa: F811
    assert rows(server) == [] and "Nobody has handed in a program" in server.researcher().get("/desk/annotate/").text
    submitted(person, text)
    ((address, title, state, _),) = rows(server)
    assert (title, state) == (TEXT["title"], "waits for review")
    page = server.researcher().get(address).text
    assert TEXT["description"][:30] in page and "Nobody has reviewed it yet" in page and page.count("<li>") > 3
    accept(reviewer(server))
    assert rows(server)[0][2] == "accepted" and "<li>accept" in server.researcher().get(address).text
    assert person.get(address).status_code == 403
    name = address.rpartition("/")[2]
    assert server.researcher().post("/desk/annotate/erase", data={"id": name}).status_code == 303
    assert rows(server) == [] and server.researcher().get(address).status_code == 404


def test_signs_of_little_care_stand_at_their_program(server, person, text):  # noqa: F811
    submitted(person, text)
    assert 'class="note"' not in rows(server)[0][3]
    other = server.person()
    described(other, f"  {TEXT['description'].upper()} ")
    ((*_, signs),) = rows(server)
    assert re.findall(r">(\w+)</span>", signs) == ["again"]


def test_thanks_come_with_the_next_description(server, person, text):  # noqa: F811
    submitted(person, text)
    assert "Thank you" not in person.get("/annotate/tasks").text
    page = person.get("/annotate/tasks?thanks=yes").text
    assert "Thank you: your program is handed in" in page and "Go on with" not in page
    described(server.person(), "Open the fridge, take the milk, pour it into a glass and drink it at the table.")
    assert "Go on with" in person.get("/annotate/tasks?thanks=yes").text
