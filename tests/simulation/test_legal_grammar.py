"""The grammar of legal commands: it writes every legal command of the moment, and no other."""

from __future__ import annotations

import json
import re
from random import Random

import pytest
from grammar_samples import Gbnf, by_bytes

from hearth.envs.agent_answers import by_text
from hearth.envs.text_agent import plain
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.env import Env

COMMANDS = 1_000


@pytest.fixture
def env(maple):
    found = Env(knowledge=default())
    found.reset(maple, 2, seed=3)
    return found


def worlds(env, number):
    """Yield views and legal instructions along a random episode."""
    rng = Random(5)
    for _ in range(number):
        may = env.legal(0)
        yield env.observe(0), may
        env.step({0: rng.choice(list(may))})


def test_a_thousand_random_commands_are_legal(env):
    rng, done = Random(1), 0
    for view, may in worlds(env, 20):
        grammar = Gbnf(may.grammar())
        for _ in range(COMMANDS // 20):
            step = by_text(grammar.sample(rng), view, may)
            assert step in may
            done += 1
    assert done == COMMANDS


def test_every_legal_command_can_be_written(env):
    for _, may in worlds(env, 4):
        every = {plain(step) for step in may}
        assert len(every) == len(may)
        one = re.compile(may.grammar("regex"))
        assert all(map(one.fullmatch, every))
        assert set(json.loads(may.grammar("schema"))["properties"]["command"]["enum"]) == every


def test_a_thousand_random_commands_under_llguidance_are_legal(env):
    rng = Random(2)
    for view, may in worlds(env, 20):
        text = may.grammar("lark")
        for _ in range(COMMANDS // 20):
            assert by_text(by_bytes("lark", text, rng), view, may) in may


def test_names_choose_the_actions_and_their_words(env):
    view, may = next(worlds(env, 1))
    text = may.grammar(names={"Walk": "Go", "Grab": "Take", "Nonsense": "x"}, wait=True)
    drawn = {Gbnf(text).sample(Random(n)) for n in range(300)}
    assert "wait" in drawn and {line.split()[0] for line in drawn} <= {"Go", "Take", "wait"}
    assert len(may.grammar()) > len(text) and view.agent == 0


def test_nothing_is_no_grammar_and_an_unknown_form_is_refused(env):
    may = env.legal(0, actions=())
    with pytest.raises(HearthError, match="EMPTY"):
        may.grammar()
    assert may.grammar(wait=True) == 'root ::= line\nline ::= "wait"\n'
    with pytest.raises(HearthError, match=r"no form of grammars.*gbnf"):
        env.legal(0).grammar("yacc")
