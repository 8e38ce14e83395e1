"""Room 2, Play: a person in a home, alone or with a helper; the server side of games and their pages.

Studies use `start_trial`, the address of `trial_address`, and `recorded_episode`.
"""

import sqlalchemy as sql

from hearth.challenges.episodes import Record
from hearth.kb.knowledge import Knowledge
from hearth.web.play import game_store, game_withdrawal, play_pages, waiting_room
from hearth.web.play.live_games import games
from hearth.web.play.play_socket import live
from hearth.web.play.play_trials import Trial
from hearth.web.room import Room, get, post, socket
from hearth.web.store import Store

ROOM = Room(
    "play",
    "Play",
    "Do things in a home, alone or with a helper.",
    addresses=(
        get("/", play_pages.start_page),
        post("/new", play_pages.new),
        get("/game/{game}", play_pages.game_page),
        get("/game/{game}/episode.jsonl", play_pages.record),
        get("/game/{game}/models/{key}.glb", play_pages.model_file),
        get("/home/{challenge}/{home}.glb", play_pages.home_file),
        socket("/game/{game}/live", live),
        get("/join/{code}", play_pages.join_page),
        post("/join/{code}", play_pages.join),
        get("/pair", waiting_room.pair_page),
        post("/pair/look", waiting_room.look),
        post("/pair/stand-in", waiting_room.with_stand_in),
        post("/pair/stop", waiting_room.stop_waiting),
    ),
    desk=(
        get("", play_pages.desk_page),
        get("/", play_pages.desk_page),
        get("/results.jsonl", play_pages.desk_results),
    ),
    needs=("three",),
    keeps=game_withdrawal.keep,
)
"""The room."""


def start_trial(connection: sql.Connection, session: str, trial: Trial, go_on: str = "/play/") -> str:
    """Begin a trial for a session, within a transaction of `Store.write`.

    Args:
        connection: of the transaction.
        session: whose trial it is; it has the first character.
        trial: as `hearth.web.play.play_trials.trial` makes it, with the helper, the interface, the seed and the view.
        go_on: address of ours to which the page leads once it is over.

    Returns:
        The game's id.
    """
    return game_store.begin(connection, session, trial, go_on)


def trial_address(game: str) -> str:
    """Return where the person plays it."""
    return f"/play/game/{game}"


def recorded_episode(store: Store, knowledge: Knowledge, game: str) -> Record | None:
    """Return the actions of a trial, as result files have them; None while it goes on.

    `hearth.web.play.game_results.results` makes files of several.
    """
    found = games(store, knowledge).open(game)
    with found.lock:
        played = found.sync()
        return played.record() if played.over else None
