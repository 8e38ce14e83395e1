"""Games in a PostgreSQL: two servers take decisions of one game, and of one tick one decision is accepted."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import pytest
from web.people import Server
from web.playing import Player, begun, session_of
from web.test_web_store import postgres  # noqa: F401

from hearth.kb.loading.load import default
from hearth.web.play.live_games import LiveGame, games
from hearth.web.play.play_trials import published
from hearth.web.web_errors import WebError

pytestmark = pytest.mark.tools


def test_two_servers_share_a_game(postgres, tmp_path, knowledge):  # noqa: F811
    servers = [Server(tmp_path / name, knowledge, postgres) for name in "ab"]
    person = servers[0].person()
    game = begun(servers[0], person, published("wah", "test-1", 0), "hp_true")
    with Player(person, game, "t") as player:
        player.act("[Turnleft]")
    stored = games(servers[0].store, default()).open(game).stored
    lives = [LiveGame(each.store, stored, default()) for each in servers]
    session = session_of(servers[0], person)

    def decide(live, tick):
        try:
            live.decide(session, "t", 0, tick, "[Turnright]")
        except WebError as error:
            return str(error.code)
        return "accepted"

    for tick in range(1, 6):
        with ThreadPoolExecutor(2) as both:
            assert sorted(both.map(decide, lives, [tick, tick])) == ["OUT_OF_ORDER", "accepted"]
    played = [live.sync().texts for live in lives]
    assert played[0] == played[1] and len(played[0]) == 6
    for each in servers:
        each.store.close()
