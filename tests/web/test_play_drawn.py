"""The 3D scene that a page draws: what is in sight, and nothing of what closed furniture holds."""

import pytest

from hearth.challenges.episode_agents import Lineup
from hearth.challenges.episodes import Job, played
from hearth.challenges.published_tasks import tasks
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.world.world import World
from hearth.web.play.game_scene_3d import DrawnGame, model_key
from hearth.web.play.games import Game
from hearth.web.play.play_trials import trial

TASK = tasks("wah", "test-1")[0]


def _held_shut(world: World) -> set[int]:
    """A plain twin of `out_of_sight`, over the graph."""
    graph = world.graph()
    shut = {node.id for node in graph.nodes if "CLOSED" in node.states and node.category != "Rooms"}
    held: set[int] = set()
    while True:
        more = {
            edge.source
            for edge in graph.edges
            if (edge.relation == "INSIDE" and edge.target in shut | held)
            or (edge.relation == "ON" and edge.target in held)
        }
        if more <= held:
            return held
        held |= more


def _shown(drawn: DrawnGame, sent: dict) -> set[int]:
    fixed = {thing.id for thing, name in drawn._base.items() if name not in sent["off"]}
    return fixed | {row[0] for row in sent["on"]}


def test_what_is_opened_is_drawn_from_then_on():
    game = Game(trial(TASK, default()), default())
    drawn = DrawnGame(game, default(), 0)
    first = _held_shut(game.playing.env.world)
    acts = iter(played(Job(TASK, 0, Lineup(), False, None, default)).actions)
    while first <= (shut := _held_shut(game.playing.env.world)):
        game.advance(next(acts))
    assert first - shut
    assert _shown(drawn, drawn.as_json()) == {thing.id for thing in drawn.scene.everything} - shut


def test_nothing_that_is_shut_in_is_drawn_at_first():
    game = Game(trial(TASK, default()), default())
    drawn = DrawnGame(game, default(), 0)
    shut = _held_shut(game.playing.env.world)
    assert shut and _shown(drawn, drawn.as_json()) == {thing.id for thing in drawn.scene.everything} - shut


def test_nobody_gets_the_model_of_a_thing_that_is_shut_in():
    game = Game(trial(TASK, default()), default())
    drawn = DrawnGame(game, default(), 0)
    shut = _held_shut(game.playing.env.world)
    seen = {model_key(thing) for thing in drawn.others()}
    things = [each for each in drawn.scene.everything if each not in drawn._base]
    unseen = next(each for each in things if each.id in shut and model_key(each) not in seen)
    with pytest.raises(HearthError, match="UNKNOWN_ID"):
        drawn.model(model_key(unseen))
