"""The two ways by which simulated people of `study_crowd.py` take part, and the server that is killed meanwhile."""

from __future__ import annotations

import html
import random
import re
import socket as sockets
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import httpx2 as httpx
import orjson
from playwright.sync_api import Browser, Error
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

T = TypeVar("T")

ROOT = Path(__file__).resolve().parents[1]

STAGES = {
    "/study/agree": "consent", "/study/understood": "tutorial", "/study/begin": "trial", "Last questions": "exit",
    "/study/answer": "questions", "Your code is": "done",
}  # fmt: skip
"""Marks of the pages, the first that a page has says its stage."""

HALT = (WebSocketException, OSError, httpx.HTTPError, Error, AssertionError)
"""Errors of a server that is killed."""

ACTS, PAUSE = 12, 0.35
"""Acts of a trial, and seconds between them, of careful people."""

OPENINGS = 4
"""Times that misbehaving people open a page anew."""


class Server:
    """A server at one address, which can be killed and started again.

    Args:
        out: its folder.
        study: the study's file.
    """

    def __init__(self, out: Path, study: Path) -> None:
        with sockets.socket() as found:
            found.bind(("127.0.0.1", 0))
            port = found.getsockname()[1]
        self.out, self.kills = out, 0
        self._command = [sys.executable, str(ROOT / "cli.py"), "serve", "--port", str(port), "--json"]
        self._command += ["--out", str(out), "--study", str(study)]
        self._lock = threading.Lock()
        self._start()

    def _start(self) -> None:
        self.process, text = subprocess.Popen(self._command, stdout=subprocess.PIPE, text=True), ""
        assert self.process.stdout is not None
        while not text.endswith("\n}\n"):
            line = self.process.stdout.readline()
            assert line, "the server ended"
            text += line
        found = orjson.loads(text)
        self.address, self.desk = found["address"], found["desk"].rpartition("/")[2]

    def kill_and_restart(self) -> None:
        """Kill the server as `kill -9` does, and start it again at the same address."""
        with self._lock:
            self.process.kill()
            self.process.wait()
            self.kills += 1
            self._start()


def again(work: Callable[[], T], seconds: float = 180.0) -> T:
    """Return what a function returns, which is called until the server answers."""
    until = time.monotonic() + seconds
    while True:
        try:
            return work()
        except HALT:
            if time.monotonic() > until:
                raise
            time.sleep(1.0)


def move(way: str, number: int, chooser: random.Random) -> str | None:
    """Return the next act of somebody: idle people wait most of the time."""
    if way == "idle" and number % 6:
        return None
    return chooser.choice(("Turnleft", "Turnright"))


def acts_of(way: str) -> tuple[int, float]:
    """Return the number of acts of a trial, and the seconds between them."""
    return (2, 0.0) if way == "too fast" else (ACTS, PAUSE)


class Client:
    """Somebody who sends over HTTP and the socket what the pages send."""

    def __init__(self, server: Server) -> None:
        self.server = server
        self.http = httpx.Client(base_url=server.address, headers={"accept": "text/html"}, timeout=60)
        self.page = ""

    def come(self, link: str) -> None:
        """Come by a link, and begin a session."""
        self._get(link)
        again(lambda: self._post("/begin", {"to": link}))

    def _get(self, path: str) -> str:
        def work() -> str:
            answer = self.http.get(path, follow_redirects=True)
            assert answer.status_code < 500, answer.status_code
            return str(answer.text)

        self.page = again(work)
        return self.page

    def _post(self, path: str, data: dict[str, str]) -> str:
        answer = self.http.post(path, data=data)
        assert answer.status_code < 500 and answer.status_code != 429, answer.status_code
        if path == "/begin":
            there = self.http.get(answer.headers["location"])
            assert there.status_code < 500, there.status_code
            self.page = there.text
        return str(answer.headers.get("location", ""))

    def stage(self) -> str:
        """Return where the person is."""
        if "/study/agree" not in self.page or self._hidden() == {}:  # the page of consent has the ids of its link
            self._get("/study/")
        return next(stage for mark, stage in STAGES.items() if mark in self.page)

    def _hidden(self) -> dict[str, str]:
        found = re.findall('<input type="hidden" name="([A-Za-z_]+)" value="([^"]*)">', self.page)
        return {name: html.unescape(value) for name, value in found}

    def go_on(self) -> None:
        """Agree, or say that one has read how it works."""
        path = "/study/agree" if "/study/agree" in self.page else "/study/understood"
        data = {"agree": "yes", **self._hidden()} if path == "/study/agree" else {}
        again(lambda: self._post(path, data))
        self.page = ""

    def leave(self) -> str:
        """Stop taking part, and return the code of the page that says so."""
        again(lambda: self._post("/study/leave", {}))
        return re.search("this code: <strong>(.+?)</strong>", self._get("/study/"))[1]  # type: ignore[index]

    def answer(self, answers: dict[str, str]) -> bool:
        """Answer the questions of the page; whether that was confirmed."""
        data = {f"answer-{name}": text[:4_000] for name, text in answers.items() if f"answer-{name}" in self.page}
        try:
            return bool(self._post("/study/answer", {**data, **self._hidden()}))
        except HALT:
            return False

    def code(self) -> str:
        """Return the code of the last page."""
        return re.search("Your code is <strong>(.+?)</strong>", self.page)[1]  # type: ignore[index]

    def play(self, way: str, chooser: random.Random) -> int:
        """Play a trial; the decisions that were confirmed."""
        game = again(lambda: self._post("/study/begin", {}))
        anew = OPENINGS if way in ("two tabs", "going back", "reloading") else 0
        at, done = 0, False
        while not done:
            try:
                at, done = self._sitting(game, way, chooser, ACTS if not anew else at + 2, at)
                if anew and not done:
                    anew -= 1
                    if way == "going back":
                        self._get("/study/")
            except HALT:
                time.sleep(1.0)
        return at

    def _sitting(self, game: str, way: str, chooser: random.Random, until: int, at: int) -> tuple[int, bool]:
        """Play from one opening of the page on; the tick, and whether the trial is over."""
        token = {"Authorization": f"Bearer {self.http.cookies['hearth']}"}
        where = f"{self.server.address.replace('http', 'ws', 1)}{game}/live"
        most, pause = acts_of(way)
        with connect(where, additional_headers=token, open_timeout=30) as socket:
            sent = iter(range(1, 10_000))

            def ask(**message: Any) -> dict[str, Any]:
                socket.send(orjson.dumps({**message, "n": next(sent)}).decode())
                found: dict[str, Any] = orjson.loads(socket.recv(60))
                assert found["type"] != "error", found
                return found

            state = ask(type="hello", tab=f"{chooser.random()}")
            while not state["over"] and state["tick"] < min(until, most):
                act = move(way, state["tick"], chooser)
                state = ask(type="act", tick=state["tick"], act=act and f"[{act}]")
                time.sleep(pause)
            at = max(at, state["tick"])
            if not state["over"] and state["tick"] >= most:
                state = ask(type="finish")
            return at, bool(state["over"])


class Page:
    """Somebody at a page of a browser, who presses what it shows."""

    def __init__(self, browser: Browser, server: Server) -> None:
        self.server = server
        self.context = browser.new_context(viewport={"width": 1200, "height": 900})
        self.page = self.context.new_page()
        self.page.set_default_timeout(30_000)

    def come(self, link: str) -> None:
        """Come by a link, and begin a session."""

        def work() -> None:
            self.page.goto(self.server.address + link)
            if self.page.get_by_role("button", name="Begin").count():
                self._press('form[action="/begin"] button')
            assert self.page.locator('form[action="/study/agree"]').count()  # many begin at once: it may be too fast

        again(work)

    def _press(self, selector: str) -> None:
        with self.page.expect_navigation():
            self.page.locator(selector).first.click()

    def stage(self) -> str:
        """Return where the person is."""

        def work() -> str:
            if not self.page.locator('form[action="/study/agree"]').count():
                self.page.goto(f"{self.server.address}/study/")
            text = self.page.content()
            found = next((stage for mark, stage in STAGES.items() if mark in text), "")
            assert found, text[:200]
            return found

        return again(work)

    def go_on(self) -> None:
        """Agree, or say that one has read how it works."""
        again(
            lambda: self._press('main form[action="/study/agree"] button, main form[action="/study/understood"] button')
        )

    def leave(self) -> str:
        """Stop taking part, and return the code of the page that says so."""
        self.page.click("details.leave summary")
        self._press('form[action="/study/leave"] button')
        return self.page.locator("main strong").inner_text()

    def answer(self, answers: dict[str, str]) -> bool:
        """Answer the questions of the page; whether that was confirmed."""
        try:
            for name, text in answers.items():
                field = f'[name="answer-{name}"]'
                if self.page.locator(f"{field}[type=radio]").count():
                    self.page.locator(f'{field}[value="{text}"]').check()
                elif self.page.locator(field).count():
                    self.page.focus(field)
                    self.page.keyboard.insert_text(text)
            self._press('form[action="/study/answer"] button')
            return self.page.url.endswith("/study/")
        except HALT:
            return False

    def code(self) -> str:
        """Return the code of the last page."""
        return self.page.locator("main .good strong").inner_text()

    def play(self, way: str, chooser: random.Random) -> int:
        """Play a trial; the decisions that were confirmed."""
        again(self._begin)
        most, pause = acts_of(way)
        anew = OPENINGS if way in ("two tabs", "going back", "reloading") else 0
        while (tick := self._tick()) < most and not self._over():
            again(lambda: self._act(move(way, tick, chooser)))
            time.sleep(pause)
            if anew:
                anew -= 1
                again(lambda: self._open_anew(way))
        again(self._finish)
        return self._tick()

    def _begin(self) -> None:
        if not self.page.locator("#game").count():
            self.page.goto(f"{self.server.address}/study/")
            self._press('form[action="/study/begin"] button')
        self.page.wait_for_selector("#game[data-tick]")

    def _tick(self) -> int:
        return int(self.page.get_attribute("#game", "data-tick") or 0)

    def _over(self) -> bool:
        return self.page.locator("#save").is_disabled()

    def _act(self, act: str | None) -> None:
        tick = self._tick()
        self.page.click(f'[data-move="{act or ""}"]')
        self.page.wait_for_selector(f'#game[data-tick="{tick + 1}"]', timeout=10_000)

    def _open_anew(self, way: str) -> None:
        if way == "reloading":
            self.page.reload()
        elif way == "going back":
            self.page.go_back()
            self.page.go_forward()
        else:
            other = self.context.new_page()
            other.goto(self.page.url)
            other.wait_for_selector("#game[data-tick]")
            self.page.click('[data-move="Turnleft"]')
            self.page.get_by_role("button", name="Go on here").click()
            self.page.locator("#banner").wait_for(state="hidden")
            other.close()
        self.page.wait_for_selector("#game[data-tick]")

    def _finish(self) -> None:
        if not self._over():
            self.page.click("#finish")
            self.page.locator("#sure").get_by_role("button", name="Finish").click()
        self.page.locator("#banner").get_by_role("link", name="Go on").wait_for(timeout=10_000)
