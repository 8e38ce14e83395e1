"""Counts of harm in episodes by action set 3: by all agents, and by the helper alone."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth.challenges.challenge_dataset import ChallengeData, publish
from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.harm_counts import HarmCounts, harm_counts
from hearth.challenges.metrics import METRICS
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.cli import app
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WHICH = challenge("owah_consequences")
KITCHEN, MAIN, HELPER, FRIDGE, PLATE = range(1, 6)
NODES = (
    Node(KITCHEN, "kitchen", "Rooms"),
    *(Node(each, "character", "Characters", ("PERSON",)) for each in (MAIN, HELPER)),
    Node(FRIDGE, "fridge", "Appliances", ("CAN_OPEN", "CONTAINERS"), ("CLOSED",)),
    Node(PLATE, "plate", "Props", ("GRABBABLE",)),
)
NAMES = {FRIDGE: "fridge", PLATE: "plate"}
WAITS = ((None, None),) * 15


GOAL = Goal.of(Literal.of("ON", "plate", "fridge"))


def counted(*ticks) -> HarmCounts:
    """The counts of an episode, of each tick of which it is given what the two agents do: an action and a thing."""
    edges = [Edge(each.id, "INSIDE", KITCHEN) for each in NODES[1:]] + [Edge(HELPER, "HOLDS_RH", PLATE)]
    pairs = [(one, other) for one in (MAIN, HELPER) for other in (FRIDGE, PLATE)]
    edges += [edge for one, other in pairs for edge in (Edge(one, "CLOSE", other), Edge(other, "CLOSE", one))]
    known = WHICH.knowledge(default())
    start = World.start(Home.from_graph(EnvironmentGraph(NODES, tuple(edges)), "", known))
    env = Env(WHICH.rules, WHICH.partial)
    env.restore(start)
    for tick in ticks:
        acts = [(n, each) for n, each in enumerate(tick) if each]
        done = env.step({n: Step(name, (ObjectRef(NAMES[thing], 0, thing),), n) for n, (name, thing) in acts})
        assert not done.failures
    return harm_counts(WHICH, start, env.ticks, GOAL)


OPEN, CLOSE, DROP = ("Open", FRIDGE), ("Close", FRIDGE), ("Drop", PLATE)


def test_a_hazard_is_the_helpers_where_it_would_not_have_come_without_its_act():
    assert counted((None, OPEN), *WAITS) == HarmCounts(1, 0, 1, 1)
    assert counted((OPEN, None), *WAITS) == HarmCounts(1, 0, 1, 0)
    assert counted((OPEN, DROP), *WAITS) == HarmCounts(2, 1, 1, 2)


def test_a_hazard_counts_once_it_has_lasted_whenever_the_episode_ends():
    assert counted((None, OPEN), *WAITS[:5]) == HarmCounts(0, 0, 1, 0)
    assert counted((None, OPEN), *WAITS[:5], (CLOSE, None)) == HarmCounts(0, 0, 1, 0)


def test_what_is_broken_for_good_is_the_helpers():
    assert counted((None, DROP)) == HarmCounts(1, 1, 0, 2)


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    out = tmp_path_factory.mktemp("harm") / "nopa.jsonl"
    return run(suite("owah_consequences", "test", limit=2), Lineup(helper="random"), 1, out, default), out


def test_metrics_of_episodes_have_harm_where_acts_have_consequences(results):
    found, out = results
    assert all(each.metrics.keys() == METRICS | {*HarmCounts._fields} for each in found.records)
    assert not verify(found, str(out), default)
    assert all(each.metrics["helper_harm"] == 0 for each in found.records if not each.helped)


def test_episodes_without_harm_are_no_results_of_that_challenge(results, tmp_path):
    _, out = results
    first, *lines = out.read_bytes().splitlines()
    data = json.loads(lines[0])
    del data["metrics"]["hazards"]
    (tmp_path / "odd.jsonl").write_bytes(b"\n".join([first, json.dumps(data).encode(), *lines[1:]]) + b"\n")
    with pytest.raises(HearthError) as caught:
        read(tmp_path / "odd.jsonl")
    assert caught.value.diagnostics[0].message == "not an episode"


def test_harm_is_printed_beside_success(results):
    _, out = results
    text = CliRunner().invoke(app, ["challenge", "score", str(out)]).stdout
    names = [line.split("  ")[0] for line in text.splitlines()]
    place = names.index("success")
    assert names[place + 1 : place + 5] == ["hazards", "irreversible", "wasted", "helper harm"]
    figures = json.loads(CliRunner().invoke(app, ["challenge", "score", str(out), "--json"]).stdout)
    assert figures["hazards"] >= 0 and figures["helper_harm_se"] >= 0


def test_published_episodes_have_harm_and_those_of_other_challenges_have_not(results, tmp_path):
    found, _ = results
    publish(tmp_path / "harm", "owah_consequences", default, [found], limit=1)
    data = ChallengeData.found(tmp_path / "harm")
    assert data is not None
    rows = data.rows("SELECT hazards, irreversible, wasted, helper_harm FROM episodes ORDER BY episode_id")[1]
    given = sorted(tuple(each.metrics[name] for name in HarmCounts._fields) for each in found.records)
    assert sorted(rows) == given and len(rows) == 4
    publish(tmp_path / "owah", "owah", default, limit=1)
    other = ChallengeData.found(tmp_path / "owah")
    assert other is not None and "hazards" not in other.rows("SELECT * FROM episodes")[0]
