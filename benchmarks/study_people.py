"""People of a study under load and under `kill -9`, over HTTP and the socket as browsers do it.

    python benchmarks/study_people.py kills [--times 20]
    python benchmarks/study_people.py load [--people 50] [--seconds 30] [--every 1.0]

`kills`: a person agrees, reads, practises, does trials with helpers, and answers; at random moments the server is
killed, and another goes on with the same folder. Every agreement, decision and answer that was confirmed must be there
then, and every trial is done again from its record; else the status is 1. `load`: everybody is in a trial of the study
and decides once in `--every` seconds on average; printed are the round trips of decisions and of the study's page, in
milliseconds.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import re
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import httpx2 as httpx
import orjson
from play_sessions import MOVES, measure, serve
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hearth.kb.loading.load import default
from hearth.studies.study_file import named
from hearth.web import sessions
from hearth.web.play import game_store
from hearth.web.play.live_games import LiveGame
from hearth.web.store import Store, default_url
from hearth.web.study.study_store import conducted

STUDY = """
name: killed
title: Tasks with helpers
room: play
seed: 5
people: {people}
consent: You may stop at any time.
tutorial: [{{title: The home, text: Walk about.}}]
practice: {practice}
tasks: {{challenge: wah, split: test-1, number: 20}}
conditions:
- {{name: alone, title: Alone}}
- {{name: hp_rg, title: HP_RG, helper: hp_random, goal: random}}
repeats: {repeats}
questions:
- {{name: note, text: What was it like?, after: trial}}
exit:
- {{name: comments, text: What else?}}
"""

HALT = (ConnectionClosed, OSError, httpx.HTTPError)
"""Errors that a person gets from a server that is killed."""


@dataclass
class Person:
    """A simulated participant, and the answers that the server confirmed.

    Attributes:
        token: of the session.
        person: the session's id.
        texts: answers in words, each unlike all others.
        agreed: whether it was confirmed that the person takes part.
        ticks: game -> the tick after the last decision that was confirmed.
    """

    token: str
    person: str
    texts: list[str] = field(default_factory=list)
    agreed: bool = False
    ticks: dict[str, int] = field(default_factory=dict)


def go_on(address: str, person: Person, chooser: random.Random) -> bool:
    """Go on with the study until the server is killed (False) or the study is done (True)."""
    try:
        with httpx.Client(base_url=address, cookies={"hearth": person.token}, timeout=30) as client:
            while "Thank you" not in (page := client.get("/study/").text):
                _one(client, address, person, page, chooser)
    except HALT:
        return False
    return True


def _one(client: httpx.Client, address: str, person: Person, page: str, chooser: random.Random) -> None:
    """Answer the page: one form, or one game."""
    if "/study/agree" in page:
        person.agreed |= client.post("/study/agree", data={"agree": "yes"}).status_code == 303
    elif "/study/understood" in page:
        client.post("/study/understood")
    elif "/study/begin" in page:
        answer = client.post("/study/begin")
        assert answer.status_code == 303, answer.text
        play(address, person, answer.headers["location"].rpartition("/")[2], chooser)
    else:
        text = f"{len(person.texts)} {chooser.random()}"
        names = re.findall(r'name="(answer-[a-z]+)"', page)
        assert names, page
        if client.post("/study/answer", data=dict.fromkeys(names, text)).status_code == 303:
            person.texts.append(text)


def play(address: str, person: Person, game: str, chooser: random.Random) -> None:
    """Some decisions, and the end of the game."""
    where = f"{address.replace('http', 'ws', 1)}/play/game/{game}/live"
    with connect(where, additional_headers={"Authorization": f"Bearer {person.token}"}) as socket:
        number, message = 1, {"type": "hello", "tab": str(chooser.random())}
        for _ in range(chooser.randint(5, 40)):
            socket.send(orjson.dumps({**message, "n": number}).decode())
            state = orjson.loads(socket.recv())
            assert state["type"] in ("begin", "tick"), state
            person.ticks[game] = max(person.ticks.get(game, 0), state["tick"])
            if state["over"]:
                return
            number, message = number + 1, {"type": "act", "tick": state["tick"], "act": chooser.choice(MOVES)}
        socket.send(orjson.dumps({"type": "finish", "n": number}).decode())
        socket.recv()


def lost(store: Store, file: Path, people: list[Person]) -> list[str]:
    """Return the confirmed answers that are not in the store."""
    conduct, missing = conducted(store, named(str(file)), default), []
    there = conduct.ledger.streams()
    for person in people:
        events = conduct.ledger.read(person.person) if person.person in there else []
        kept = [text for each in events for text in each.data.get("answers", {}).values()]
        missing += [f"answer {text}" for text in person.texts if text not in kept]
        missing += ["agreement"] * (person.agreed and not events)
        for game, tick in person.ticks.items():
            live = LiveGame(store, store.read(lambda connection, it=game: game_store.stored(connection, it)), default())
            missing += [f"decision {number} of {game}" for number in range(live.sync().tick, tick)]
    return missing


def begun(folder: Path, people: int, practice: int, repeats: int) -> tuple[Store, Path]:
    """A store, and the file of a study."""
    file = folder / "killed.yaml"
    file.write_text(STUDY.format(people=people, practice=practice, repeats=repeats))
    return Store(default_url(folder / "served")), file


def joined(store: Store) -> Person:
    """A new session."""
    session = sessions.start(store)
    return Person(session.token, session.id)


def kills(times: int, folder: Path) -> int:
    """Kill, go on, compare, print; the number of what was lost."""
    (folder / "served").mkdir()
    store, file = begun(folder, people=20, practice=1, repeats=1)
    chooser, missing, people = random.Random(0), [], [joined(store)]
    for _ in range(times):
        process, address = serve(folder / "served", "--study", str(file))
        timer = threading.Timer(chooser.uniform(1, 9), process.kill)
        timer.start()
        while go_on(address, people[-1], chooser):
            people.append(joined(store))
        process.wait()
        missing += lost(store, file, people)
    conduct = conducted(store, named(str(file)), default)
    trials = sum(each.kind == "did" for person in conduct.ledger.streams() for each in conduct.ledger.read(person))
    answers, decisions = sum(len(each.texts) for each in people), sum(sum(each.ticks.values()) for each in people)
    print(f"{times} kills: {len(people)} people, {trials} trials, {answers} answers, {decisions:,} decisions;", end=" ")
    print(f"{len(missing)} of what was confirmed is lost", *missing[:5])
    return len(missing)


def load(people: int, seconds: float, every: float, folder: Path) -> None:
    """Everybody begins a trial, all decide at once; print."""
    (folder / "served").mkdir()
    store, file = begun(folder, people=people, practice=0, repeats=max(2, -(-people // 20)))
    some = [joined(store) for _ in range(people)]
    process, address = serve(folder / "served", "--study", str(file))
    try:
        games = [(person.token, in_trial(address, person)) for person in some]
        asyncio.run(measure(address, games, every, 3.0))  # homes are read
        with ThreadPoolExecutor(1) as beside:
            pages = beside.submit(page_times, address, some, seconds)
            shown("decisions", asyncio.run(measure(address, games, every, seconds)), people)
            shown("pages of the study meanwhile", pages.result(), people)
    finally:
        process.kill()
        process.wait()
    print(f"load of this machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


def in_trial(address: str, person: Person) -> str:
    """The game of a person's first trial, which is begun."""
    with httpx.Client(base_url=address, cookies={"hearth": person.token}, timeout=60) as client:
        for path, data in (("agree", {"agree": "yes"}), ("understood", {}), ("begin", {})):
            answer = client.post(f"/study/{path}", data=data)
            assert answer.status_code == 303, answer.text
    return answer.headers["location"].rpartition("/")[2]


def page_times(address: str, people: list[Person], seconds: float) -> list[float]:
    """The seconds of the study's page, which now one, now another asks for."""
    found, until = [], time.monotonic() + seconds
    while time.monotonic() < until:
        person = people[len(found) % len(people)]
        with httpx.Client(base_url=address, cookies={"hearth": person.token}, timeout=60) as client:
            since = time.perf_counter()
            assert client.get("/study/").status_code == 200
            found.append(time.perf_counter() - since)
        time.sleep(0.2)
    return sorted(found)


def shown(what: str, times: list[float], people: int) -> None:
    """Print the percentiles of sorted times."""
    parts = {"median": 0.5, "95%": 0.95, "99%": 0.99}
    values = ", ".join(f"{name} {1000 * times[int(len(times) * part)]:.1f} ms" for name, part in parts.items())
    print(f"{people} people of a study, {len(times):,} {what}: {values}")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("kills", "load"))
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--people", type=int, default=50)
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--every", type=float, default=1.0)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        if asked.what == "load":
            load(asked.people, asked.seconds, asked.every, Path(folder))
        elif kills(asked.times, Path(folder)):
            sys.exit(1)


if __name__ == "__main__":
    main()
