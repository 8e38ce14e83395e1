"""A node that an agent does not see changes no byte of the agent's observation, in any form."""

from __future__ import annotations

import random
from dataclasses import replace
from functools import cache

import orjson
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scrambled_worlds import scrambled

from hearth.envs.agent_answers import by_text
from hearth.envs.answer_forms import read_answer
from hearth.envs.compact_text import compact, wanted_nodes
from hearth.envs.json_observations import observation
from hearth.envs.text_agent import description, menu, plain
from hearth.envs.text_protocol_settings import protocol
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.actions.legal import legal
from hearth.simulation.env import Env
from hearth.simulation.observation.views import view
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.bits import indices
from hearth.simulation.world.digest import digest
from hearth.simulation.world.home import Home

GOAL = Goal.of(
    (Literal.of("ON", "plate", "table"), 2), Literal.of("HOLDS", "agent", "milk"), Literal.of("CLOSED", "fridge"),
    Literal("ON", ("book", "sofa"), True), Literal.of("INSIDE", "apple", "fridge"), Literal.of("OPEN", "cupboard"),
)  # fmt: skip

FORMS = {
    "ids": lambda seen, may: seen.ids,
    "graph": lambda seen, may: seen.graph,
    "poses": lambda seen, may: (seen.me, seen.others, seen.tick),
    "legal": lambda seen, may: (list(may), len(may), {name: may.objects(name) for name in sorted(may.masks)}),
    "json": lambda seen, may: orjson.dumps(observation(seen, GOAL)),
    "hearth-text/1": lambda seen, may: compact(seen, may, GOAL, protocol()),
    "text": lambda seen, may: description(seen, GOAL) + menu(list(may), seen),
}
"""(view, legal) -> the form, as a value or as bytes. A new form of observations is a row here."""


@cache
def home(name: str) -> Home:
    return Home.from_graph(library.load_graph(name, default()), name, default())


def middle(seed: int, ticks: int) -> Env:
    """An episode of two agents, in the middle: they walk by metres and at once, open, close, take and put."""
    chooser = random.Random(seed)
    env = Env(DEFAULT._replace(bodies=bool(seed % 2)), knowledge=default())
    env.reset(home(library.names()[seed % 7]), 2, seed=seed)
    for _ in range(ticks):
        env.step({number: _random(env, number, chooser) for number in (0, 1)})
    return env


def _random(env, number, chooser):
    may = env.legal(number, only_visible=chooser.random() < 0.7)
    liked = [name for name in ("Walk", "Open", "Close", "Grab", "PutBack", "PutIn", "Sit") if name in may.masks]
    action = chooser.choice([*liked, *liked, *sorted(may.masks)])
    there = env.world.home
    nodes = [chooser.choice(may.objects(action, position)) for position in range(len(may.masks[action]))]
    return Step(action, tuple(ObjectRef(there.classes[there.index[node]], 0, node) for node in nodes), number)


def pair(seed: int, ticks: int, number: int, mix: int):
    """Two views, equal in all that is seen, with what is legal in each."""
    env = middle(seed, ticks)
    other = scrambled(env.world, number, random.Random(mix))
    found = []
    for world in (env.world, other):
        seen = view(world, number, last_actions=env._last_actions, tick=len(env.ticks))
        found.append((seen, legal(world, number, env.rules, only_visible=True)))
    return found


def test_the_two_worlds_differ_and_the_scrambling_is_of_every_kind():
    env = middle(3, 12)
    other = scrambled(env.world, 0, random.Random(1))
    assert digest(other) != digest(env.world)
    before, after = env.world.graph(), other.graph()
    old, new = {n.id: n for n in before.nodes}, {n.id: n for n in after.nodes}
    assert new.keys() - old.keys() and old.keys() - new.keys()
    assert any(old[i].states != new[i].states for i in old.keys() & new.keys())
    assert set(legal(env.world, 0)) != set(legal(other, 0))


@pytest.mark.parametrize("form", FORMS)
@given(seed=st.integers(0, 10_000), ticks=st.integers(0, 25), number=st.integers(0, 1), mix=st.integers(0, 10_000))
@settings(max_examples=10)
def test_what_is_unseen_does_not_show(form, seed, ticks, number, mix):
    (seen, may), (again, may_again) = pair(seed, ticks, number, mix)
    assert FORMS[form](seen, may) == FORMS[form](again, may_again)


def asked(text, seen, may, read=by_text):
    try:
        return read(text, seen, may)
    except HearthError as error:
        return [replace(each, source="") for each in error.diagnostics]


@given(seed=st.integers(0, 10_000), mix=st.integers(0, 10_000))
@settings(max_examples=10)
def test_answers_ask_nothing_about_what_is_unseen(seed, mix):
    """The refusals and their words are the same; unseen nodes are refused as nodes that do not exist."""
    (seen, may), (again, may_again) = pair(seed, 10, 0, mix)
    chooser = random.Random(mix)
    there = seen.world.home
    unseen = [i for i in range(len(there)) if not seen.mask >> i & 1] + chooser.sample(range(len(there)), 10)
    for i in chooser.sample(unseen, 15):
        for action in ("Walk", "Grab", "Open", "Walktowards", "LookAt"):
            for text in (f"{action} {there.classes[i]} {there.ids[i]}", f"[{action}] <{there.classes[i]}> (2)"):
                assert asked(text, seen, may) == asked(text, again, may_again), text
    for text in ("Grab apple 99999", "Open cupboard", "PutBack milk, table", "Walkforward", "StandUp"):
        assert asked(text, seen, may) == asked(text, again, may_again), text
    nothing, hidden = asked(f"Grab apple {there.ids[-1] + 50}", seen, may), None
    for i in indices(there.by_class.get("apple", 0) & ~seen.mask):
        hidden = asked(f"Grab apple {there.ids[i]}", seen, may)
        assert [each.code for each in hidden] == [each.code for each in nothing] == ["NOT_SEEN"]


@given(seed=st.integers(0, 10_000), number=st.integers(0, 1), mix=st.integers(0, 10_000))
@settings(max_examples=10)
def test_other_forms_of_answers_ask_nothing_about_what_is_unseen(seed, number, mix):
    (seen, may), (again, may_again) = pair(seed, 10, number, mix)
    found, other = (wanted_nodes(GOAL, each.world.home, each.mask) for each in (seen, again))
    assert not found & ~seen.mask and found == other

    def read(text, seen, may):
        return read_answer(text, seen, may, protocol())

    for text in (
        "go to fridge 1",
        "Grab apple",
        "open the cupboard",
        "take milk 5 from fridge 3",
        "Walk bedroom",
        "fly",
    ):
        assert asked(text, seen, may, read) == asked(text, again, may_again, read), text


@given(seed=st.integers(0, 10_000))
@settings(max_examples=10)
def test_only_walks_are_offered_that_the_rest_of_the_home_prevents(seed):
    env = middle(2 * seed, 8)
    offered = set(env.legal(0)) - set(env.legal(0, only_visible=False))
    assert {step.action for step in offered} <= {"Walk", "Run", "Find", "Walktowards"}


def test_what_one_faces_is_not_named_once_it_is_shut_away():
    env = Env(knowledge=default())
    env.reset(home("maple"))
    for text in ("[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[TurnTo] <milk> (1)", "[Close] <fridge> (1)"):
        assert not env.step(text).failures
    assert env.world.agents[0].facing and env.observe().me.facing == ()


def test_clothes_that_another_wears_are_seen_where_it_is():
    env = Env(knowledge=default())
    env.reset(home("maple"), agents=2, seed=1)
    for name in ("shirt", "pants", "shoes", "hat", "coat"):
        if env.world.home.instances(name):
            for text in (f"[Walk] <{name}> (1)", f"[Grab] <{name}> (1)", f"[PutOn] <{name}> (1)"):
                env.step(text)
    env.step("[Walk] <fridge> (1)")
    env.step("<char1> [Walk] <fridge> (1)")
    (other,) = env.observe(1).others
    assert other.wearing and set(other.wearing) <= set(env.observe(1).ids)


def test_text_names_what_it_lists():
    env = middle(2, 5)
    may = env.legal(0)
    options = list(may)
    assert all(by_text(plain(step), env.observe(0), may) == step for step in options[::7])
