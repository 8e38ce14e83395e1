"""Helpers' beliefs in episodes, their scores and drawings, and people unlike the one that helpers were tuned with."""

from __future__ import annotations

import importlib.util
from dataclasses import replace

import pytest

from hearth.agents.goal_space import GoalSpace
from hearth.agents.human_population import PEOPLE
from hearth.agents.network_proposals import NetworkProposals
from hearth.agents.predicate_count_changes import StateChanges
from hearth.analysis.goal_belief_figure import drawn
from hearth.analysis.online_inference import calibration, inference
from hearth.challenges.challenge_dataset import ChallengeData, publish
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.helper_beliefs import Beliefs, Moment, beliefs
from hearth.challenges.learning_to_propose import Wish, episode
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS
from hearth.schemas.rng import rng

OWAH = challenge("owah")
FEW = suite("owah", "train", 5, 2)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return run(FEW, Lineup(helper="nopa"), 1, tmp_path_factory.mktemp("runs") / "nopa.jsonl", default)


@pytest.fixture(scope="module")
def believed(results, knowledge):
    return beliefs(FEW.tasks[0], list(results.records)[1], "nopa", knowledge)


def test_a_helper_believes_ever_more_of_the_true_goal(results, believed):
    assert len(believed.moments) == len(list(results.records)[1].actions)
    first, last = believed.moments[0], believed.moments[-1]
    assert last.truth > first.truth and last.f1 > first.f1
    wanted = [number for number, count in enumerate(believed.goal) if count]
    assert all(last.wanted[number] > 0.9 for number in wanted)


def test_beliefs_of_who_infers_nothing_are_refused(results, knowledge):
    with pytest.raises(HearthError, match="infers no goal"):
        beliefs(FEW.tasks[0], list(results.records)[1], "hp", knowledge)
    with pytest.raises(HearthError, match="infers no goal"):
        beliefs(FEW.tasks[0], replace(list(results.records)[1], helped=False), "nopa", knowledge)


def test_a_goal_that_nobody_has_there_is_refused(results, knowledge):
    """Of a stranger's results, whose digests anybody can make fit."""
    record = list(results.records)[1]
    with pytest.raises(HearthError, match="is none that people have"):
        beliefs(replace(FEW.tasks[0], goal=Goal(())), record, "nopa", knowledge)


def test_an_episode_without_ticks_is_drawn(believed):
    assert "<polyline" in drawn(replace(believed, moments=()), ())


def test_inference_is_scored_over_time(results):
    found = inference(results, default)
    f1 = [row["f1"] for row in found["over_time"]]
    assert found["episodes"] == 2 and 0 <= f1[0] < f1[-1] <= 1
    assert found["over_time"][0]["log_loss"] > found["over_time"][-1]["log_loss"] >= 0


def test_calibration_by_hand():
    """Probability .25 twice, once true; .9 once, true: (|.25 - .5| * 2 + |.9 - 1|) / 3 = .2."""
    moment = Moment((0.25, 0.25, 0.9), 0.5, 0.5)
    found = calibration([Beliefs(("a", "b", "c"), (1, 0, 2), (moment,))])
    assert found["calibration_error"] == pytest.approx(0.2)
    assert [each["cases"] for each in found["calibration"]] == [2, 1]


def test_the_figure_has_a_line_for_each_predicate_of_the_goal(believed):
    svg = drawn(believed, [(1, 0, "Grab <plate> (3)", ""), (2, 1, "Open fridge", "NOT_CLOSE")])
    assert svg.count("<polyline") == 8 and "wanted" in svg
    assert "&lt;plate&gt;" in svg and "Open fridge" not in svg


def test_posteriors_are_a_table(results, tmp_path):
    counts = publish(tmp_path, "owah", default, [results], limit=1)
    assert counts["posteriors"] > 0
    data = ChallengeData.found(tmp_path)
    assert data is not None
    query = "SELECT max(probability), min(probability), count(DISTINCT episode_id) FROM posteriors WHERE wanted > 0"
    _, ((most, least, episodes),) = data.rows(query)
    assert 0.01 <= least < most <= 1 and episodes == 2


@pytest.mark.parametrize("kind", sorted(PEOPLE))
def test_people_of_every_kind_reach_their_goals_with_help(kind, tmp_path):
    found = run(suite("owah", "train", 5, 1), Lineup(main=kind, helper="expected_time"), 1, tmp_path / "r", default)
    assert [each.metrics["success"] for each in found.records] == [True, True]


def test_the_near_sighted_see_less(knowledge):
    lineup = Lineup(main="near_sighted", helper="nopa").checked()
    start = FEW.tasks[0].start(knowledge)
    players = lineup.players(OWAH, FEW.tasks[0].goal_in(start.home), None, knowledge, True)
    assert [player.partial for player in players] == [True, None]


def test_states_are_counted_since_the_start(knowledge):
    world = FEW.tasks[0].start(knowledge)
    space = GoalSpace.of(OWAH.goals_in(world.home), world.home)
    first = space.places(world)
    changes = StateChanges(space, world.agents[0].index, first)
    assert changes.size == 31 + 3 * 11 and not any(changes.since(first))
    held = [(HOLDS, world.agents[0].index), *first[1:]]
    assert sum(changes.since(held)) == 1
    other = [(HOLDS, world.agents[1].index), *first[1:]]
    assert not any(changes.since(other))
    target = [(space.relations[space.rows_of[0][0]], int(space.targets[space.rows_of[0][0]])), *first[1:]]
    assert changes.since(target)[space.rows_of[0][0]] == 1


def test_an_episode_to_learn_from_ends_where_its_goal_says():
    found = episode(Wish(FEW.tasks[0], default))
    assert sum(found.counts) == OWAH.grammar.size(FEW.tasks[0].goal)
    assert not any(found.states[0]) and sum(found.states[-1]) >= sum(found.counts) - 1


def test_proposals_of_the_network_follow_what_was_put_where(knowledge):
    if importlib.util.find_spec("torch") is None or importlib.util.find_spec("safetensors") is None:
        pytest.skip("the extra `models` is not installed")
    world = FEW.tasks[0].start(knowledge)
    space = GoalSpace.of(OWAH.goals_in(world.home), world.home)
    first = space.places(world)
    network = NetworkProposals(space, "goal-proposals-small", world.agents[0].index, space.places(world))
    row = next(n for n, each in enumerate(space.predicates) if each.name == "INSIDE")
    thing = next(number for number, rows in enumerate(space.rows_of) if row in rows)
    there = [*first[:thing], ("INSIDE", int(space.targets[row])), *first[thing + 1 :]]
    before, after = network.probabilities(first)[row, 1:].sum(), network.probabilities(there)[row, 1:].sum()
    assert after > 2 * before
    goals = network.drawn(there, 50, rng(0, "drawn"))
    assert len(goals) == 50 and abs(sum(goal[row] > 0 for goal in goals) / 50 - after) < 0.25
