"""Episodes of MCP clients: one for a session, bounded in number, closed when idle; the SDK is not needed for this."""

from __future__ import annotations

import time

import pytest

from hearth.commands.mcp_episodes import SessionEpisodes
from hearth.schemas.diagnostics import HearthError

HOLD = ("maple", "HOLDS(agent, milk)")


def refused(work):
    with pytest.raises(HearthError) as caught:
        work()
    return str(caught.value.diagnostics[0].code)


def held(episodes, session, name=""):
    with episodes.of(session, name) as (found, episode):
        return found, episode.turn


def test_a_session_has_its_last_episode_alone():
    episodes = SessionEpisodes("wah:train:2", 5, 3)
    first, *_ = episodes.begin("one", *HOLD, 1)
    other, *_ = episodes.begin("two", *HOLD, 2)
    second, _, turn = episodes.begin("one", *HOLD, 3)
    assert held(episodes, "one") == (second, turn) and held(episodes, "two")[0] == other
    assert refused(lambda: held(episodes, "one", first)) == "UNKNOWN_ID"
    assert held(episodes, None, other)[0] == other
    assert refused(lambda: held(episodes, None)) == "OUT_OF_ORDER"
    assert refused(lambda: held(episodes, "three")) == "OUT_OF_ORDER"


def test_the_number_is_bounded_and_one_that_is_over_makes_room():
    episodes = SessionEpisodes("wah:train:2", 1, 2)
    first, *_ = episodes.begin(None, *HOLD, 1)
    episodes.begin(None, *HOLD, 2)
    assert refused(lambda: episodes.begin(None, *HOLD, 3)) == "TOO_FAST"
    with episodes.of(None, first) as (_, episode):
        assert episode.step("wait").done
    episodes.begin(None, *HOLD, 3)
    assert refused(lambda: held(episodes, None, first)) == "UNKNOWN_ID"


def test_an_idle_one_is_closed():
    episodes = SessionEpisodes("wah:train:2", 5, 2, idle=0.05)
    name, *_ = episodes.begin("one", *HOLD, 1)
    time.sleep(0.1)
    assert refused(lambda: held(episodes, "one", name)) == "UNKNOWN_ID"


def test_a_second_call_before_the_first_is_answered_is_refused():
    episodes = SessionEpisodes("wah:train:2", 5, 2)
    name, *_ = episodes.begin("one", *HOLD, 1)
    with episodes.of("one", name):
        assert refused(lambda: held(episodes, "one")) == "LOCKED"
    assert held(episodes, "one")[0] == name
