"""The tables of requests: they name known actions, classes and slots."""

from collections import Counter

import pytest

from hearth.kb.action_sets import LATEST
from hearth.kb.loading.load import default
from hearth.models.reading.clause_reader import CONSUME, PUT_AWAY, PUT_NEAR, PUT_TO
from hearth.models.reading.request_table import is_slot, requests, words
from hearth.schemas.yaml_limits import packaged

KNOWN = default().of_set(LATEST)
OURS = {CONSUME, PUT_AWAY, PUT_NEAR, PUT_TO}
TOGETHER = {"?": "acts that are left out where they cannot be done"}


def test_every_act_is_an_action_with_its_objects():
    for request in requests():
        for act in (act for way in request.ways for act in way):
            assert act.action in OURS or KNOWN.actions[act.action].arity == len(act.arguments), act


def test_every_class_is_known():
    names = {name for request in requests() for way in request.ways for act in way
             for some, _ in act.arguments for name in some}  # fmt: skip
    plain = {name.partition("/")[0] for name in names if not is_slot(name) and not name.endswith("@")}
    assert {name for name in plain if name not in KNOWN.objects and name not in words().things} == set()
    for noun, classes in words().things.items():
        assert any(KNOWN.object_class(name) for name in classes), noun


def test_every_slot_of_an_act_is_in_each_pattern_or_filled_by_the_last_thing():
    for request in requests():
        required = {slot for act in request.ways[0] for slot in act.slots if not act.optional}
        for pattern in request.patterns:
            assert required <= {*pattern.needs, *request.it}, pattern.pattern.pattern


def test_every_need_is_a_property_a_kind_or_a_class():
    known = {*KNOWN.objects, *KNOWN.kinds, "room"} | {each for one in KNOWN.objects.values() for each in one.properties}
    needs = {need.removeprefix("!") for request in requests() for pattern in request.patterns
             for some in pattern.needs.values() for need in some}  # fmt: skip
    assert needs <= known, needs - known


@pytest.mark.parametrize("name", ["courtesy", "openings"])
def test_words_around_requests_take_nothing_else(name):
    assert getattr(words(), name).fullmatch("the milk") is None


def test_no_pattern_and_no_word_of_a_group_stands_twice():
    data = packaged("hearth.kb.language", "requests.yaml")
    patterns = [pattern for row in data["requests"] for pattern in row["say"]]
    assert [pattern for pattern, number in Counter(patterns).items() if number > 1] == []
    groups = {name: Counter(words) for name, words in data["words"].items()}
    assert {name: words for name, words in groups.items() if max(words.values()) > 1} == {}
