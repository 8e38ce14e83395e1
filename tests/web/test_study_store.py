"""Studies in the store, by servers that share it: every place is given once; SQLite and PostgreSQL."""

from __future__ import annotations

import threading

import pytest
from studies.small import small
from web.test_web_store import postgres  # noqa: F401

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.studies.events import Event
from hearth.studies.study_progress import CONSENT, TUTORIAL
from hearth.web import sessions
from hearth.web.store import Store, default_url
from hearth.web.study.study_store import conducted


def test_everybody_who_joins_at_once_has_a_place_of_their_own(tmp_path):
    joined_at_once(default_url(tmp_path))


@pytest.mark.tools
def test_everybody_who_joins_at_once_has_a_place_of_their_own_in_postgres(postgres):  # noqa: F811
    joined_at_once(postgres)


def joined_at_once(url):
    """Eight people at two servers join a study of four places."""
    stores = [Store(url), Store(url)]
    conducts = [conducted(store, small(), default) for store in stores]
    people = [sessions.start(stores[0]).id for _ in range(8)]
    places, refused = {}, []

    def join(number):
        try:
            places[people[number]] = conducts[number % 2].join(people[number]).place
        except HearthError as error:
            refused.append(error.diagnostics[0].message)

    threads = [threading.Thread(target=join, args=(number,)) for number in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert sorted(places.values()) == [0, 1, 2, 3]
    assert refused == ["every place in this study is taken"] * 4
    first, second = list(places)[:2]
    assert conducts[0].consent(first).stage == TUTORIAL == conducts[1].standing(first).stage
    assert not conducts[1].ledger.append(Event(first, 0, "consented", 1.0, {}))
    assert conducts[0].ledger.secret("x") == conducts[1].ledger.secret("x") != conducts[0].ledger.secret("y")
    conducts[1].forget(first)
    assert conducts[0].ledger.read(first) == []
    late = next(each for each in people if each not in places)
    assert conducts[0].join(late).place == places[first]
    assert conducts[1].standing(second).stage == CONSENT
    for store in stores:
        store.close()
