"""The server that is attacked, what of a person's must stay as it is, and what every answer must be."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from attack import Attack, Ground
from starlette.testclient import TestClient

from hearth.kb.loading.load import default
from hearth.web.application import application
from hearth.web.limits import RATES, Rate
from hearth.web.play import start_trial
from hearth.web.play.play_trials import published, trial
from hearth.web.sessions import find
from hearth.web.store import Store, default_url

DESK, BASE = "the-token-of-the-desk", "http://127.0.0.1"
MINE = "a private title"
STUDY = "people-alone"


class Site(NamedTuple):
    """The server that is attacked, and a person with something of its own in every room."""

    made: TemporaryDirectory[str]
    store: Store
    app: Any
    owner: TestClient
    text: str
    game: str

    def client(self, **options: Any) -> TestClient:
        return TestClient(self.app, base_url=BASE, follow_redirects=False, **options)

    def person(self) -> TestClient:
        client = self.client()
        assert client.post("/begin").status_code == 303
        return client


@cache
def site() -> Site:
    """The server."""
    made = TemporaryDirectory()
    out = Path(made.name)
    store = Store(default_url(out))
    rates = dict.fromkeys(RATES, Rate(10_000, 10_000))
    app = application(store, default(), out, DESK, study=Path(STUDY), rates=rates)
    owner = TestClient(app, base_url=BASE, follow_redirects=False)
    owner.post("/begin")
    session = find(store, owner.cookies["hearth"])
    assert session is not None
    owner.post(
        "/annotate/describe",
        data={"title": MINE, "description": "Sit down on the sofa. Then watch a film on television."},
    )
    (text,) = re.findall(r'href="/annotate/task/([^"]+)"', owner.get("/annotate/tasks").text)
    chosen = trial(published("wah", "test-1", 0), default())
    game = store.write(lambda connection: start_trial(connection, session.id, chosen))
    owner.post("/study/agree", data={"agree": "yes"})
    return Site(made, store, app, owner, text, game)


def checked(answer: Any, refused: bool = False) -> str:
    """The text of an answer that is not a fault of the server, and has the policy; `refused` ones have no success."""
    assert answer.status_code < 500 or answer.status_code == 503, answer.status_code
    assert "script-src 'self'" in answer.headers["content-security-policy"]
    assert "set-cookie" not in answer.headers or "\n" not in answer.headers["set-cookie"]
    assert not refused or answer.status_code in (303, 307, 400, 401, 403, 404, 405, 409, 413, 415, 422), (
        answer.status_code
    )
    text: str = answer.text
    assert "Traceback" not in text
    return text


def attack_on_site(name: str, call: Callable[[], Any]) -> Attack:
    """An attack on the server, after which what its owner has is looked at."""

    def run(ground: Ground) -> Any:
        found = call()
        _untouched()
        return found

    return Attack("web", name[:120], run)


def _untouched() -> None:
    """Check that the owner's data are as they were."""
    here = site()
    assert here.owner.get("/mine").status_code == 200
    assert MINE in here.owner.get("/annotate/tasks").text
