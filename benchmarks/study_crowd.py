"""A study of many simulated people, a third of whom misbehave in ten ways, with a kill of the server in the middle.

    python benchmarks/study_crowd.py [--people 60] [--browsers 12] [--together 4] [--out FOLDER]

The first `--browsers` people, with all ten ways among them, are pages of a Chromium, `--together` at a time; the others
send over HTTP and the socket what the pages send. Once half of them are done, the server is killed and started again at
the same address, while people are in the middle of a task. Then the desk, the list for payment, the tables and the
report are compared with what each person did and was given. The status is 1 if anything differs.
"""

from __future__ import annotations

import argparse
import csv
import io
import random
import re
import shutil
import socket as sockets
import sys
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import count
from pathlib import Path
from typing import Any

import duckdb
import httpx2 as httpx
from crowd_clients import Client, Page, Server
from playwright.sync_api import sync_playwright

from hearth.commands.study import export, report

STUDY = """
name: crowd
title: Tasks with a helper
room: play
seed: 5
people: {people}
consent: You may stop at any time.
tutorial: [{{title: The home, text: Walk about.}}]
practice: 0
tasks: {{challenge: wah, split: test-1, number: {tasks}}}
conditions:
- {{name: alone, title: Alone}}
- {{name: hp_rg, title: HP_RG, helper: hp_random, goal: random}}
repeats: {repeats}
at_least: 1
limits: {{minutes: 20, idle_hours: 24, least_seconds: 3}}
recruitment: {{platform: prolific, completion: "https://app.prolific.com/submissions/complete?cc=C1"}}
questions:
- {{name: helpful, text: How helpful was it?, scale: {{from: 1, to: 7}}, after: trial}}
- {{name: check, text: Choose 2 here., scale: {{from: 1, to: 7}}, correct: 2, after: trial}}
- {{name: note, text: What was it like?, after: trial}}
exit:
- {{name: comments, text: What else?, required: false}}
"""

WAYS: dict[str, str] = {
    "too fast": "fast", "idle": "idle", "repeated": "repeated", "gibberish": "gibberish", "two tabs": "reopened",
    "going back": "reopened", "reloading": "reopened", "novels": "long", "emoji": "gibberish", "leaving": "",
}  # fmt: skip
"""The ways to misbehave, each with its flag at the desk; who leaves is counted as having left."""


@dataclass
class Person:
    """A simulated participant.

    Attributes:
        number: from 0.
        way: of `WAYS`; "" for somebody careful.
        code: that the last page gave.
        given: what the server confirmed: the words that were written.
        ticks: decisions that the server confirmed.
    """

    number: int
    way: str
    code: str = ""
    given: list[str] = field(default_factory=list)
    ticks: int = 0

    @property
    def link(self) -> str:
        """The address by which the person comes."""
        return f"/study/?PROLIFIC_PID=p{self.number}&STUDY_ID=s&SESSION_ID=x{self.number}"

    def words(self, trial: int) -> str:
        """Return the text of the person after a trial."""
        if self.way == "repeated":
            return "It was quite all right."
        if self.way == "gibberish":
            return f"sdfgh jklm qwrtz {'xcvb' * (trial + 1)}"
        if self.way == "novels":
            return f"{trial}. " + "It was the best of times, it was the worst of times. " * 60
        if self.way == "emoji":
            return "😀👍🏠" * (trial + 1)
        return f"In task {trial + 1} person {self.number} walked about and looked at the furniture."


def crowd(people: int) -> list[Person]:
    """A third of the people misbehave, each way as often; these come first, for browsers to have all ways."""
    wrong = people // 3
    ways = list(WAYS)
    return [Person(number, ways[number % len(ways)] if number < wrong else "") for number in range(people)]


def take_part(person: Person, door: Any, chooser: random.Random) -> None:
    """Go the whole way, and go on wherever the server was killed.

    Args:
        person: who.
        door: a page of a browser, or a client that sends what pages send.
        chooser: of the acts.
    """
    door.come(person.link)
    for trial in count():
        while (stage := door.stage()) in ("consent", "tutorial"):
            door.go_on()
        if stage == "trial":
            if person.way == "leaving" and trial == 1:
                person.code = door.leave()
                return
            person.ticks += door.play(person.way, chooser)
        while door.stage() == "questions":
            words = person.words(trial)
            if door.answer({"helpful": str(2 + (trial + person.number) % 5), "check": "2", "note": words}):
                person.given.append(words[:4_000].strip())
        if door.stage() == "exit":
            door.answer({"comments": ""})
        if door.stage() == "done":
            person.code = door.code()
            return


def run(people: list[Person], browsers: int, together: int, server: Server, chromium: str) -> list[str]:
    """Let everybody take part; the errors of those who could not."""
    faults: list[str] = []
    done = count(1)
    half = len(people) // 2

    def finish(person: Person, door: Any) -> None:
        try:
            take_part(person, door, random.Random(person.number))
        except Exception as error:
            faults.append(f"person {person.number} ({person.way or 'careful'}): {type(error).__name__}: {error}"[:300])
        if next(done) == half:
            server.kill_and_restart()

    def pages() -> None:
        for batch in _batches(people[:browsers], together):
            with ThreadPoolExecutor(together) as pool:
                list(pool.map(in_browser, batch))

    def in_browser(person: Person) -> None:
        with sync_playwright() as playwright:
            browser = playwright.chromium.connect_over_cdp(chromium)
            finish(person, Page(browser, server))

    beside = threading.Thread(target=pages)
    beside.start()
    with ThreadPoolExecutor(20) as pool:
        list(pool.map(lambda person: finish(person, Client(server)), people[browsers:]))
    beside.join()
    return faults


@contextmanager
def one_browser() -> Iterator[str]:
    """Start the one browser whose contexts are people; the address that threads reach it by."""
    with sockets.socket() as found:
        found.bind(("127.0.0.1", 0))
        port = found.getsockname()[1]
    path = shutil.which("chromium") or "chromium"
    arguments = ["--no-sandbox", f"--remote-debugging-port={port}"]
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=path, args=arguments)
        yield f"http://127.0.0.1:{port}"
        started.close()


def _batches(people: list[Person], size: int) -> Iterator[list[Person]]:
    yield from (people[start : start + size] for start in range(0, len(people), size))


def compared(people: list[Person], server: Server, folder: Path) -> list[str]:
    """Return the differences of the desk, the payments, the tables and the report from the people."""
    found: list[str] = []
    with httpx.Client(base_url=server.address, headers={"authorization": f"Bearer {server.desk}"}, timeout=120) as desk:
        listed = {
            row["platform_id"]: row for row in csv.DictReader(io.StringIO(desk.get("/desk/study/payments.csv").text))
        }
        page = desk.get("/desk/study/").text
    export(server.out, out=folder / "tables")
    report(server.out, out=folder / "report")
    rows = duckdb.sql(f"SELECT * FROM '{folder}/tables/participants.parquet'").fetchall()
    columns = [each[0] for each in duckdb.sql(f"SELECT * FROM '{folder}/tables/participants.parquet'").description]
    table = {row["participant"]: row for row in (dict(zip(columns, each, strict=True)) for each in rows)}
    query = f"SELECT participant, sum(ticks)::int FROM '{folder}/tables/trials.parquet' GROUP BY ALL"
    decided = dict(duckdb.sql(query).fetchall())
    for person in people:
        name, row = f"person {person.number} ({person.way or 'careful'})", listed.get(f"p{person.number}")
        if row is None or row["code"] != person.code or person.code not in page or person.code not in table:
            found.append(f"{name}: the code {person.code} is not that of the desk and the tables: {row}")
            continue
        wanted = WAYS.get(person.way, "")
        if row["flags"].split() != ([wanted] if wanted else []) or table[person.code]["flags"] != row["flags"].split():
            found.append(f"{name}: flags {row['flags']!r}, expected {wanted!r}")
        stage = "left" if person.way == "leaving" else "done"
        if row["stage"] != stage or table[person.code]["stage"] != stage:
            found.append(f"{name}: stage {row['stage']}, expected {stage}")
        if decided.get(person.code, 0) < person.ticks:
            found.append(f"{name}: {decided.get(person.code)} ticks, {person.ticks} were confirmed")
    kept = Counter(value for (value,) in duckdb.sql(f"SELECT text FROM '{folder}/tables/ratings.parquet'").fetchall())
    wrote = Counter(text for person in people for text in person.given)
    found += [f"an answer is kept {kept[text]} times of {times}: {text[:60]}" for text, times in wrote.items()
              if kept[text] < times]  # fmt: skip
    done = sum(person.way != "leaving" for person in people)
    written = (folder / "report" / "index.html").read_text()
    if not re.search(rf"\b{done}\b", re.sub("<[^>]+>", " ", written)):
        found.append(f"the report does not count {done} people")
    return found


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--people", type=int, default=60)
    parser.add_argument("--browsers", type=int, default=12)
    parser.add_argument("--together", type=int, default=4)
    parser.add_argument("--out", type=Path)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        folder = asked.out or Path(made)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "study.yaml").write_text(STUDY.format(people=asked.people, tasks=asked.people, repeats=1))
        people, since = crowd(asked.people), time.monotonic()
        server = Server(folder / "served", folder / "study.yaml")
        try:
            with one_browser() as chromium:
                faults = run(people, asked.browsers, asked.together, server, chromium)
            faults += compared(people, server, folder)
        finally:
            server.process.kill()
    wrong = Counter(each.way for each in people if each.way)
    how = f"{asked.browsers} of them pages of a browser ({asked.together} at once), the others over HTTP"
    print(f"{len(people)} people, {how}")
    print(f"{sum(wrong.values())} misbehave: {', '.join(f'{way} {number}' for way, number in wrong.items())}")
    ticks, answers = sum(each.ticks for each in people), sum(len(each.given) for each in people)
    print(f"{ticks:,} decisions and {answers} answers confirmed;", end=" ")
    print(f"the server was killed {server.kills} time; {time.monotonic() - since:.0f} s")
    print(f"{len(faults)} differ", *faults, sep="\n")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
