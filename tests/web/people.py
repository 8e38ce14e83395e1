"""Fixtures of the tests of the server: a server in this process, people at it, a browser, a server of its own."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from hearth.web.application import application
from hearth.web.limits import RATES, Rate
from hearth.web.store import Store, default_url
from hearth.web.third_party_scripts import missing

ROOT = Path(__file__).resolve().parents[2]
DESK = "the-desk-token-of-these-tests"
BASE = "http://127.0.0.1"
CHROMIUM = ("--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
            "--disable-sync")  # fmt: skip


class Server:
    """A server in this process; `client()` is a browser of somebody without a session, `person()` with one."""

    def __init__(self, out: Path, knowledge, url: str = "", **options) -> None:
        self.out, self.store = out, Store(url or default_url(out))
        options = {"rates": dict.fromkeys(RATES, Rate(10_000, 10_000)), **options}
        self.app = application(self.store, knowledge, out, DESK, **options)

    def client(self, **options) -> TestClient:
        options = {"client": ("127.0.0.1", 50_000), **options}
        return TestClient(self.app, base_url=BASE, follow_redirects=False, **options)

    def person(self) -> TestClient:
        client = self.client()
        assert client.post("/begin").status_code == 303
        return client

    def researcher(self) -> TestClient:
        return self.client(headers={"authorization": f"Bearer {DESK}"})


@pytest.fixture
def server(tmp_path, knowledge):
    made = Server(tmp_path / "served", knowledge)
    yield made
    made.store.close()


@pytest.fixture
def person(server):
    return server.person()


class Serving:
    """`python cli.py serve` in a process of its own; `address` and `desk` are what it printed.

    Args:
        out: its folder.
        options: of the command.
        limits: what a shell does first, such as `ulimit -n 64`; what the server logs is in `log` then.
    """

    def __init__(self, out: Path, *options: str, limits: str = "") -> None:
        self.out, self.log = out, out.with_name("log.txt")
        command = [sys.executable, str(ROOT / "cli.py"), "serve", "--port", "0", "--json", "--out", str(out), *options]
        if limits:
            command = ["sh", "-c", f'{limits}; exec "$@" 2>>{shlex.quote(str(self.log))}', "sh", *command]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=dict(os.environ))
        text, line = "", None
        while line != "}\n":
            line = self.process.stdout.readline()
            assert line, "the server ended"
            text += line
        found = json.loads(text)
        self.address, self.desk = found["address"], found["desk"]

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()


@pytest.fixture
def serving(tmp_path):
    """Starts servers in processes of their own; all are killed at the end."""
    started: list[Serving] = []

    def start(*options: str, out: Path | None = None, limits: str = "") -> Serving:
        started.append(Serving(out or tmp_path / "served", *options, limits=limits))
        return started[-1]

    yield start
    for each in started:
        each.kill()


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    """One server in a process of its own for the tests of a file."""
    started = Serving(tmp_path_factory.mktemp("one") / "served")
    yield started
    started.kill()


@pytest.fixture
def browser():
    """A Chromium; each page's console is to be watched with `watched`."""
    playwright = pytest.importorskip("playwright.sync_api")
    path = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if path is None:
        pytest.skip("no Chromium here: apt-get install chromium")
    with playwright.sync_playwright() as running:
        started, uncaught = running.chromium.launch(executable_path=path, args=list(CHROMIUM)), []
        yield strict(started, uncaught)
        started.close()
    assert uncaught == [], "a page's script failed"


WEBGL = ("--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader")


@pytest.fixture
def drawing(browser):
    """A page of a browser that draws in 3D, in software."""
    if "three" in missing():
        pytest.skip("no three.js: make web")
    faults = []
    started = strict(browser.browser_type.launch(executable_path=shutil.which("chromium"), args=list(WEBGL)), faults)
    yield started.new_context(viewport={"width": 1400, "height": 1000}).new_page()
    started.close()
    assert faults == []


def strict(started, uncaught: list[str]):
    """The browser; an error that a script of any page of it did not catch is put into `uncaught`."""
    plain = started.new_context

    def new_context(**options):
        context = plain(**options)
        context.on("weberror", lambda found: uncaught.append(f"{found.page.url}: {found.error}"))
        return context

    started.new_context = new_context
    return started


AXE = ROOT / "web/node_modules/axe-core/axe.min.js"


def watched(page, faults: list[str]):
    """The page, with everything that its console says of errors collected in `faults`."""
    page.on("console", lambda said: faults.append(said.text) if _is_fault(said) else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    return page


def _is_fault(said) -> bool:
    return said.type in ("error", "warning") and "GPU stall due to ReadPixels" not in said.text  # a picture of a canvas


def accessibility(page) -> list[str]:
    """Findings of axe-core that are serious or critical, as `rule: element`; skipped where it is not fetched."""
    if not AXE.is_file():
        pytest.skip("no axe-core: make web")
    page.evaluate(AXE.read_text())  # by the debugger, which the policy does not concern
    run = "axe.run({preload: location.protocol !== 'file:'})"  # a browser does not let a file read others
    found = page.evaluate(f"async () => (await {run}).violations")
    serious = [each for each in found if each["impact"] in ("serious", "critical")]
    return [f"{each['id']}: {node['html'][:200]}" for each in serious for node in each["nodes"]]
