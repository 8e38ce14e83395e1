"""Studies' files: what is wrong is named with its line and its remedy."""

import pytest
from studies.small import SMALL, small

from hearth.schemas.diagnostics import HearthError
from hearth.studies.study_file import SHIPPED, named, study_of
from hearth.studies.study_trials import check_helpers


def faults(text):
    with pytest.raises(HearthError) as caught:
        study_of(text, "study.yaml")
    return caught.value.diagnostics


def fault(old, new):
    assert old in SMALL
    (found, *_) = faults(SMALL.replace(old, new, 1))
    return found


def test_the_small_study_is_read():
    study = small()
    assert (study.name, study.items, study.trials, study.practice) == ("small", 4, 8, 1)
    assert [each.helped for each in study.conditions] == [False, True]
    assert study.asked(study.conditions[0]) == ()
    assert [each.name for each in study.asked(study.conditions[1])] == ["helpful"]


def test_the_studies_that_ship_are_read():
    assert [named(name).name for name in SHIPPED] == list(SHIPPED)


@pytest.mark.parametrize(
    ("old", "new", "line", "message", "remedy"),
    [
        ("room: play", "room: plya", 4, "`room` is `plya`", "write one of play, judge"),
        ("people: 4", "people: 0", 6, "`people` is `0`", "write a whole number from 1 to 5,000"),
        ("people: 4", "peple: 4", 2, "a study needs `people`", ""),
        ("hp_random", "hp_randm", 14, "there is no helper `hp_randm`", "none, random,"),
        ("hp_random, goal: random", "hp_true", 14, "`hp_true` reads its partner's plan", "hp, hp_random"),
        ("number: 4", "number: 4000", 11, "the split has 100 tasks", "at most 100"),
        ("split: test", "split: tset", 11, "there is no split `tset`", "train"),
        ("from: 1, to: 7", "from: 7, to: 1", 17, "the scale from 7 to 1 is empty", "`from` is below `to`"),
        ("{name: alone,", "{name: hp_rg,", 12, "two conditions are called `hp_rg`", "rename one of them"),
        (
            "at_least: 1",
            "at_least: 2",
            6,
            "place 1 has 1 trial under `alone`, where `at_least` is 2",
            "write `people: 2` or `repeats: 2`",
        ),
        ("room: play", "room: judge", 4, "people who judge need `films`", "films: {of: episodes"),
        ("choices: [young, old]", "choices: [young]", 19, "`choices` is a list of two or more texts", ""),
    ],
)
def test_a_fault_has_its_line_and_its_remedy(old, new, line, message, remedy):
    found = fault(old, new)
    assert (found.file, found.line) == ("study.yaml", line)
    assert message in found.message
    assert remedy in found.suggestion


@pytest.mark.parametrize("key", ["²", "9" * 900, "٣", "x", "8"])
def test_labels_are_of_numbers_of_the_scale(key):
    found = fault("labels: {1: hurting", f"labels: {{'{key}': hurting")
    assert "`labels` gives words to numbers of the scale" in found.message


def test_every_fault_is_named_at_once_with_its_words():
    found = faults(SMALL.replace("room: play", "room: plya").replace("people: 4", "people: x"))
    assert [each.line for each in found[:2]] == [4, 6]
    assert found[0].source == "room: plya"


def test_the_helpers_are_those_of_the_thesis():
    helpers = {name: [each.helper for each in named(name).conditions] for name in ("people-with-helpers", "online")}
    assert helpers == {
        "people-with-helpers": ["hp", "hybrid", "hp_random"],
        "online": ["none", "nopa_gpn", "hp_gpn", "hp_random"],
    }


def test_a_study_whose_helpers_ask_networks_does_not_begin_without_them(monkeypatch):
    monkeypatch.setattr("hearth.challenges.episode_agents.lacking", lambda extra: ["torch"])
    check_helpers(named("people-alone"))
    with pytest.raises(HearthError, match="torch is not installed"):
        check_helpers(named("people-with-helpers"))


def test_yaml_that_holds_itself_is_refused():
    assert faults("&a [*a]")


@pytest.mark.parametrize(
    ("challenge", "helper"),
    [
        ("owah", "asking"),
        *(("wah", name) for name in ("asking", "nopa_gpn", "nopa_gpn_s", "hp_gpn", "hp_gpn_s", "af_gpn")),
    ],
)
def test_a_helper_that_would_end_every_trial_is_a_fault_of_the_file(challenge, helper):
    split = "test-1" if challenge == "wah" else "test"
    text = SMALL.replace("challenge: owah, split: test", f"challenge: {challenge}, split: {split}")
    text = text.replace("helper: hp_random, goal: random", f"helper: {helper}")
    (found,) = faults(text)
    assert (found.line, found.code) == (14, "BAD_ARGUMENT")
    assert f"`{helper}` can't help in `{challenge}`" in found.message
    assert found.suggestion.startswith("hp, nopa")
    assert study_of(text, "study.yaml", begun=True).name == "small", "what was collected with it is still to be read"


@pytest.mark.parametrize("helper", ["nopa_gpn", "hp_gpn_s", "af_gpn", "nopa"])
def test_the_same_networks_help_where_they_were_trained(helper):
    assert study_of(SMALL.replace("helper: hp_random, goal: random", f"helper: {helper}"), "study.yaml").name == "small"
