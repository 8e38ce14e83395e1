"""Attacks by texts that people write on the server's pages: none may be markup there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from attack import Attack
from attacked_site import DESK, attack_on_site, checked, site
from starlette.testclient import TestClient

TEXTS = (
    "<script>alert(1)</script>",
    '"><img src=x onerror=alert(1)>',
    "</title><svg onload=alert(1)>",
    "{{7*7}}",
    "${7*7}",
    "=cmd|' /C calc'!A0",
    "javascript:alert(1)",
)


def pages() -> Iterator[Attack]:
    """Every text, by every way in which a person's texts reach a page."""
    for text in TEXTS:
        for name, write in WRITERS.items():
            yield attack_on_site(f"{name}: {text}", lambda w=write, t=text: w(t))


def _described(text: str) -> None:
    person = site().person()
    person.post(
        "/annotate/describe", data={"title": text[:80], "description": f"{text} Sit down. Then {text} watch a film."}
    )
    _nowhere(text, person, "/annotate/tasks", "/annotate/")


def _refused_field(text: str) -> None:
    """Texts that come back in what is refused."""
    person = site().person()
    for path, data in (
        ("/annotate/describe", {"title": text}),
        ("/play/new", {"challenge": text, "task": text}),
        ("/begin", {"to": text}),
    ):
        answer = person.post(path, data=data, headers={"accept": "text/html"})
        checked(answer)
        assert answer.headers.get("location", "/").startswith("/")
        _no_markup(text, answer)


def _special(text: str) -> None:
    """A program with a hostile special block, on the pages of its writer and of the desk."""
    here, person = site(), site().person()
    person.post(f"/annotate/task/{here.text}/scene", data={"room living_room": "1", "version": "1"})
    version = person.get(f"/annotate/task/{here.text}/work").json()["version"]
    checked(person.post(f"/annotate/task/{here.text}/save", json={"version": version, "steps": [{"special": text}]}))
    _nowhere(text, person, f"/annotate/task/{here.text}/compose", f"/annotate/task/{here.text}")
    desk = here.client(headers={"authorization": f"Bearer {DESK}"})
    _nowhere(text, desk, "/desk/annotate/")


def _left_study(text: str) -> None:
    person = site().person()
    person.post("/study/agree", data={"agree": "yes"})
    for path in ("understood", "answer", "begin", "leave"):
        checked(person.post(f"/study/{path}", data={"answer-comments": text, "person": text}))
    _nowhere(text, person, "/study/")
    desk = site().client(headers={"authorization": f"Bearer {DESK}"})
    checked(desk.post("/desk/study/forget", data={"person": text}))
    _nowhere(text, desk, "/desk/study/")


WRITERS = {"description": _described, "refused": _refused_field, "special block": _special, "study": _left_study}


def _nowhere(text: str, client: TestClient, *paths: str) -> None:
    for path in paths:
        answer = client.get(path)
        checked(answer)
        _no_markup(text, answer)


def _no_markup(text: str, answer: Any) -> None:
    page = "text/html" in answer.headers.get("content-type", "")
    assert not page or "<" not in text or text not in answer.text
    assert not page or text not in ("{{7*7}}", "${7*7}") or ">49<" not in answer.text
