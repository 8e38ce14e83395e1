"""The language of a request: of the study that is served, else of the browser, else English."""

from starlette.requests import HTTPConnection

from hearth.schemas.diagnostics import HearthError
from hearth.web.phrases import ENGLISH, preferred, speak
from hearth.web.room_request import Web
from hearth.web.study.study_pages import study_here

TRANSLATED = ("/study", "/play/game/", "/play/pair", "/play/join/", "/mine", "/come", "/phrases.js")
"""Beginnings of the addresses whose pages are there in every language; all others are English."""


def speak_to(web: Web, asked: HTTPConnection) -> None:
    """Say sentences in the language of a request from now on."""
    if not asked.url.path.startswith(TRANSLATED):
        speak(ENGLISH)
        return
    speak(_of_study(web) or preferred(asked.headers.get("accept-language", "")))


def _of_study(web: Web) -> str:
    """Return the language of the server's study; "" where it names none."""
    try:
        study = study_here(web)
    except HearthError:  # its pages say what is wrong
        return ""
    return "" if study is None else study.language
