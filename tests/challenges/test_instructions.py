"""Instructions in English: every goal has several, and each is read back as its goal."""

from __future__ import annotations

import re
from random import Random

import pytest

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.instruction_object_names import EVERY, are, nouns, wordings
from hearth.challenges.instruction_reader import read_instruction
from hearth.challenges.instruction_writer import instruction
from hearth.challenges.published_tasks import tasks
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal
from tests.challenges.random_goals import random_goal

POOLS = tuple(wordings()["pools"])
VERBS = {"{are}", "{sit}"}
PLATES = Goal.of((Literal.of("ON", "plate", "dining_table"), 2), Literal.of("ON", "fork", "dining_table"))


@pytest.mark.parametrize("name", ["wah", "owah"])
@pytest.mark.parametrize("pool", POOLS)
def test_every_goal_of_a_challenge_is_read_back(knowledge, name, pool):
    grammar = challenge(name).grammar
    for number, goal in enumerate(grammar.goals):
        for terse in (True, False):
            text = instruction(goal, knowledge, number, pool=pool, doer="agent:0", terse=terse)
            assert read_instruction(text, knowledge, "agent:0", grammar.names) == goal, text


def test_goals_of_every_form_are_read_back(knowledge):
    for seed in range(1_500):
        chooser = Random(seed)
        goal = random_goal(chooser, knowledge)
        family = chooser.choice(("", *wordings()["family_frames"]))
        text = instruction(goal, knowledge, seed, pool=chooser.choice(POOLS), family=family)
        assert read_instruction(text, knowledge) == goal, text


def test_a_goal_has_three_wordings_and_one_is_terse(knowledge):
    for pool in POOLS:
        plain = {instruction(PLATES, knowledge, seed, pool=pool, terse=False) for seed in range(40)}
        terse = {instruction(PLATES, knowledge, seed, pool=pool, terse=True) for seed in range(40)}
        assert len(plain | terse) >= 3 and terse
        assert max(map(len, terse)) < max(map(len, plain))


def test_the_same_seed_gives_the_same_words(knowledge):
    assert instruction(PLATES, knowledge, 7) == instruction(PLATES, knowledge, 7)
    assert len({instruction(PLATES, knowledge, seed) for seed in range(20)}) > 3


@pytest.mark.parametrize(
    ("literal", "number", "words"),
    [
        (Literal.of("ON", "agent", "chair"), 1, ("sit down on the chair", "find the chair and sit on it")),
        (Literal.of("ON", "agent", "bed"), 1, ("sit or lie down on the bed", "find the bed and sit or lie on it")),
        (
            Literal.of("ON", "agent:1", "chair"),
            1,
            ("let person 1 sit on the chair", "get person 1 to sit on the chair"),
        ),
        (Literal.of("HOLDS", "agent", "umbrella"), 1, ("pick up an umbrella", "grab an umbrella")),
        (Literal.of("ON", "shoes", "agent"), 1, ("put on a pair of shoes", "wear a pair of shoes")),
        (
            Literal.of("ON", "shoes", "agent:1"),
            1,
            ("put a pair of shoes on person 1", "leave a pair of shoes on person 1"),
        ),
        (
            Literal("ON", ("walllamp",), True),
            1,
            ("switch off every wall lamp", "make sure that every wall lamp is off"),
        ),
        (Literal.of("OPEN", "window"), 2, ("open two windows", "make sure that two windows are open")),
        (Literal.of("ON", "pan", "oven"), 1, ("put a pan on the oven", "lay a pan on the oven")),
    ],
)
def test_an_instruction_says_what_is_wanted(knowledge, literal, number, words):
    """Sitting is asked where one can sit, things on the agent are worn, and a verb agrees with its things."""
    for pool, clause in zip(("train", "test"), words, strict=True):
        said = {instruction(Goal.of((literal, number)), knowledge, seed, pool=pool, terse=False) for seed in range(60)}
        assert any(clause in text[0].lower() + text[1:] for text in said), said


def test_only_numbers_name_agents(knowledge):
    assert instruction(Goal.of(Literal.of("ON", "agent", "chair")), knowledge, doer="agent:0", terse=True) == (
        "Anybody to sit on the chair")  # fmt: skip
    assert str(read_instruction("Let anybody sit on the chair.", knowledge, "agent:0")) == "ON(agent, chair)"


def test_lists_agree_with_their_verb():
    plate, cup = ("plate", 1), ("cup", 1)
    assert [are(each) for each in ((plate,), (plate, cup), (("plate", 2),))] == ["is", "are", "are"]
    assert are((("plate", EVERY), ("cup", EVERY))) == "is"


def test_no_wording_is_in_two_pools():
    data = wordings()
    every = [{pool: data["frames"][pool] for pool in POOLS}, *data["clauses"].values()]
    for pools in every:
        texts = [text for pool in POOLS for kind in pools[pool].values() for text in kind]
        assert len(texts) == len(set(texts)), texts
    for pools in data["family_frames"].values():
        texts = [text for pool in POOLS for text in pools[pool]]
        assert len(texts) == len(set(texts)), texts


def test_every_clause_has_plain_and_terse_wordings_in_every_pool():
    for key, pools in wordings()["clauses"].items():
        slots = {
            frozenset(re.findall(r"\{\w+\}", text)) - VERBS
            for p in pools.values()
            for kind in p.values()
            for text in kind
        }
        assert len(slots) == 1, key
        assert [*pools] == [*POOLS] and all(pools[pool]["plain"] and pools[pool]["terse"] for pool in POOLS), key


def test_every_class_has_a_noun_and_a_plural_of_its_own(knowledge):
    found = nouns(knowledge)
    assert set(knowledge.objects) <= set(found.singular.values())
    assert set(knowledge.objects) <= set(found.plural.values())


def test_published_tasks_have_instructions(knowledge):
    for name, split in (("wah", "train"), ("wah", "test-2"), ("owah", "test")):
        for task in tasks(name, split, limit=30):
            assert task.read(task.instruction, knowledge) == task.goal
            assert len({task.worded(knowledge, number) for number in range(12)}) >= 3


def test_words_of_a_person_come_before_the_instruction(knowledge):
    text = "Dinner. My aunt comes, and she is hungry. In short: Put a plate on the dining table."
    assert str(read_instruction(text, knowledge)) == "ON(plate, dining_table)"


@pytest.mark.parametrize(
    "text",
    [
        "",
        "Fly to the moon.",
        "Put two plate on the dining table.",
        "Put a plate on the moon.",
        "(" * 4_000,
        "a" * 30_000,
    ],
)
def test_what_is_not_understood_is_refused(knowledge, text):
    with pytest.raises(HearthError) as caught:
        read_instruction(text, knowledge)
    assert caught.value.diagnostics[0].code is Code.SYNTAX


def test_brackets_may_not_be_too_deep(knowledge):
    text = "let this not be so: (" * 40 + "open a fridge" + ")" * 40
    with pytest.raises(HearthError, match="brackets"):
        read_instruction(text, knowledge)
