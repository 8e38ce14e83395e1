"""The desk's page of a trial: every tick with its time and words, and the same in 3D on a timeline."""

from __future__ import annotations

import re

import pytest
from studies.small import SMALL
from web.people import Server
from web.playing import Player
from web.used_controls import NARROW, WIDE, fits

from hearth.kb.loading.load import default
from hearth.web.study.study_store import opened_store

ACTS = ("[Turnleft]", None, "[Turnright]")


def played(person, post, get):
    """Somebody does the practice and the first trial."""
    post("/study/agree", {"agree": "yes"})
    post("/study/understood", {})
    for acts in ((), ACTS):
        where = person.post("/study/begin").headers["location"]
        with Player(person, where.rpartition("/")[2]) as player:
            for act in acts:
                player.patient_act(act)
            player.ask({"type": "finish"})
        get("/study/")


@pytest.fixture
def studied(tmp_path, knowledge):
    """A study in which somebody has played a trial; and that person's code."""
    (tmp_path / "study.yaml").write_text(SMALL)
    server = Server(tmp_path / "served", knowledge, study=tmp_path / "study.yaml")
    person = server.person()
    played(person, lambda path, data: person.post(path, data=data), person.get)
    conduct = opened_store(server.out, "", "", default).conduct
    yield server, conduct.code(conduct.ledger.streams()[0])
    server.store.close()


def test_each_tick_has_its_row_with_time_and_words(studied):
    server, code = studied
    desk = server.researcher()
    assert f'href="/desk/study/trial/{code}/1"' in desk.get("/desk/study/").text
    page = desk.get(f"/desk/study/trial/{code}/1").text
    rows = re.findall(r'<tr data-shown="(\d+)">(.*?)</tr>', page, re.DOTALL)
    assert len(rows) == len(ACTS)
    assert "Turn left" in rows[0][1] and "Turn right" in rows[2][1] and "Turn" not in rows[1][1]
    seconds = [float(re.search(r'number">([\d.]+)<', row)[1]) for _, row in rows]
    assert seconds == sorted(seconds)
    assert int(rows[0][0]) <= int(rows[1][0]) <= int(rows[2][0])


def test_a_trial_that_there_is_not_is_unknown_and_people_see_none(studied):
    server, code = studied
    desk = server.researcher()
    for path in (f"{code}/2", f"{code}/0", f"{code}/x", "nobody/1", f"{code}/1e3"):
        assert desk.get(f"/desk/study/trial/{path}").status_code == 404
    for path in ("", "/replay.json"):
        assert server.person().get(f"/desk/study/trial/{code}/1{path}").status_code == 403


def test_the_replay_has_as_many_steps_as_the_rows_say(studied):
    pytest.importorskip("trimesh")
    server, code = studied
    desk = server.researcher()
    found = desk.get(f"/desk/study/trial/{code}/1/replay.json").json()
    shown = re.findall(r'data-shown="(\d+)"', desk.get(f"/desk/study/trial/{code}/1").text)
    assert len(found["run"]["ticks"]) - 1 == int(shown[-1])


@pytest.mark.tools
@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_the_timeline_is_dragged_and_a_tick_chosen(browser, serving, tmp_path, width):
    import httpx2 as httpx

    (tmp_path / "study.yaml").write_text(SMALL)
    server = serving("--study", str(tmp_path / "study.yaml"))
    with httpx.Client(base_url=server.address, timeout=60) as client:
        client.post("/begin")
        _play_over_http(client, server.address)
    page = browser.new_page(viewport={"width": width, "height": 900})
    page.set_default_timeout(120_000)
    page.goto(server.desk)
    page.goto(f"{server.address}/desk/study/")
    page.get_by_role("link", name=re.compile("^Trial 1 of")).click()
    page.wait_for_selector("#scrubber:not([disabled])")
    assert fits(page)
    last = int(page.get_attribute("#scrubber", "max"))
    assert last >= 2
    page.locator("#scrubber").fill(str(last))
    page.wait_for_selector(f".replay[data-tick='{last}']")
    assert page.locator("tr.now").count()
    page.locator("button[data-go]").first.click()
    first = page.locator("button[data-go]").first.get_attribute("data-go")
    page.wait_for_selector(f".replay[data-tick='{first}']")
    page.click("#play")
    page.wait_for_selector(f".replay[data-tick='{last}']")


def _play_over_http(client, address):
    from websockets.sync.client import connect

    class Socket:
        def __init__(self, path):
            token = {"Authorization": f"Bearer {client.cookies['hearth']}"}
            self.socket = connect(address.replace("http", "ws", 1) + path, additional_headers=token)

        def say(self, **message):
            import orjson

            self.socket.send(orjson.dumps(message).decode())
            return orjson.loads(self.socket.recv(60))

    client.post("/study/agree", data={"agree": "yes"})
    client.post("/study/understood")
    for acts in ((), ACTS):
        where = client.post("/study/begin").headers["location"]
        socket = Socket(f"{where}/live")
        state = socket.say(type="hello", tab="a", n=1)
        for number, act in enumerate(acts, 2):
            state = socket.say(type="act", tick=state["tick"], act=act, n=number)
        socket.say(type="finish", n=len(acts) + 2)
        client.get("/study/")
