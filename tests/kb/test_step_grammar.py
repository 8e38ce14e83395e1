"""The grammar of steps, in four forms: whatever is written under it parses and is of the action grammar."""

from __future__ import annotations

import json
import re
from random import Random

import pytest
from grammar_samples import Gbnf, by_bytes, of_schema

from hearth.kb.action_grammar import check
from hearth.kb.tools.export import export
from hearth.kb.tools.line_grammars import line_grammar, regex, trie
from hearth.kb.tools.step_grammar import MOST_STEPS, argument_sets
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program

STEPS = 1_000


def faults(text, knowledge):
    program, syntax = parse_program(text)
    checked, wrong = check(program, knowledge, source=text.splitlines())
    assert len(checked.steps) == len(text.splitlines())
    return [*syntax, *wrong]


def test_a_thousand_random_steps_of_gbnf_parse(knowledge):
    grammar, rng, steps, actions = Gbnf(export(knowledge, "grammar")), Random(1), 0, set()
    while steps < STEPS:
        text = grammar.sample(rng)
        assert faults(text, knowledge) == [] and len(text.splitlines()) <= MOST_STEPS
        steps += len(text.splitlines())
        actions |= set(re.findall(r"\[(\w+)\]", text))
    assert len(actions) > 70


def test_the_actions_are_all_that_something_affords(knowledge):
    found = {name for names in argument_sets(knowledge).values() for name in names}
    assert found == set(knowledge.actions) and len(argument_sets(knowledge)) < len(found)


def test_random_programs_of_the_schema_parse(knowledge):
    schema, rng = json.loads(export(knowledge, "grammar-schema")), Random(2)
    for _ in range(60):
        for step in of_schema(schema, rng)["steps"]:
            if step.get("object1") == step.get("object2", 0):
                continue  # a schema cannot say that two objects differ
            objects = "".join(f" <{step[key]}> (1)" for key in ("object1", "object2") if key in step)
            assert faults(f"[{step['action']}]{objects}", knowledge) == []


def test_the_regular_expression_matches_steps_and_nothing_else(knowledge):
    one = re.compile(export(knowledge, "grammar-regex").strip())
    steps = Gbnf(export(knowledge, "grammar")).sample(Random(3)).splitlines()
    assert len(steps) > 3 and all(map(one.fullmatch, steps))
    for wrong in ("[Grab] <sky> (1)", "[Fly]", "[Grab] <milk>", "[Grab] <milk> (0)", "[Grab] <milk> (1) <cup> (1)", ""):
        assert not one.fullmatch(wrong), wrong


def test_no_object_is_named_twice_and_every_pair_can_be_written(knowledge):
    one = re.compile(export(knowledge, "grammar-regex").strip())
    pairs = 0
    for sets, names in argument_sets(knowledge).items():
        for action in names if len(sets) == 2 else ():
            for name, other in [(sets[0][0], sets[1][0]), *((a, b) for a in sets[0][::9] for b in sets[1][::5])]:
                assert not one.fullmatch(f"[{action}] <{name}> (3) <{name}> (3)")
                number = 2 if name == other else 1
                assert one.fullmatch(f"[{action}] <{name}> (1) <{other}> ({number})"), (action, name, other)
                pairs += 1
    assert pairs > 1_000


@pytest.mark.parametrize(("form", "name"), [("lark", "grammar-lark"), ("regex", "grammar-regex")])
def test_a_thousand_random_steps_under_llguidance_parse(knowledge, form, name):
    rng, steps, text = Random(4), 0, export(knowledge, name).strip("\n")
    for _ in range(STEPS):
        written = by_bytes(form, text, rng)
        assert faults(written, knowledge) == [], written
        steps += len(written.splitlines())
        if steps >= (STEPS if form == "lark" else 20):
            break


def test_forms_are_named_and_equal_every_time(knowledge):
    for form in ("grammar", "grammar-lark", "grammar-regex", "grammar-schema"):
        text = export(knowledge, form)
        assert 30_000 < len(text) < 150_000 and text == export(knowledge, form)


@pytest.mark.parametrize(
    "texts",
    [["a"], ["a", "ab", "b"], ["a.b", "a*b", "a-b"], ['say "x"', "say \\", "a/b", "[x]"], ["", "a"], ["x" * 5000]],
)
def test_a_trie_matches_its_texts_alone(texts):
    found = re.compile(trie(texts))
    assert all(found.fullmatch(text) for text in texts)
    assert not any(found.fullmatch(text + "x") for text in texts if text + "x" not in texts)
    assert not found.fullmatch("aXb")


def test_hostile_texts_are_quoted():
    parts = [["say ", ('"quoted"', "back\\slash", "a | b", "x::=y", "{1,2}")]]
    grammar = line_grammar(parts)
    from hearth.kb.tools.line_grammars import gbnf

    drawn = {Gbnf(gbnf(grammar)).sample(Random(n)) for n in range(60)}
    assert drawn == {f"say {text}" for text in parts[0][1]}
    assert all(re.fullmatch(regex(grammar), text) for text in drawn)


def test_no_alternative_is_no_grammar():
    with pytest.raises(HearthError, match="EMPTY"):
        line_grammar([["Grab ", ()]])
