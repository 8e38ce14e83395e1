"""Contradictions, things used from afar, programs that do nothing, other words, what was declared."""

import pytest

from hearth.kb import action_grammar
from hearth.kb.loading.load import default
from hearth.pipelines.checks import meaning_checks
from hearth.pipelines.crowd import topics
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program, print_step


def program(text, title="", description=""):
    found, faults = parse_program(text)
    assert not faults
    return Program(title, description, found.steps, found.lines)


def test_switched_on_twice():
    steps = "[SwitchOn] <tv> (1)\n[SwitchOn] <tv> (2)\n[SwitchOn] <tv> (1)\n[SwitchOff] <tv> (1)\n[SwitchOn] <tv> (1)\n"
    (found,) = meaning_checks.contradictions(program(steps), default())
    assert (found.code, found.step, found.remove) == ("CONTRADICTION", 2, True)


@pytest.mark.parametrize(
    ("steps", "missing"),
    [
        ("[Walk] <bedroom> (1)\n[Sit] <sofa> (1)\n", [(1, "[Walk] <sofa> (1)")]),
        ("[Walk] <kitchen> (1)\n[Grab] <cup> (1)\n", [(1, "[Walk] <cup> (1)")]),
        ("[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n", []),
        ("[Walk] <kitchen> (1)\n[Walk] <table> (1)\n[Grab] <cup> (1)\n", []),
        ("[Find] <cup> (1)\n[Grab] <cup> (1)\n[PutBack] <cup> (1) <sofa> (1)\n", [(2, "[Walk] <sofa> (1)")]),
    ],
)
def test_used_without_a_walk(knowledge, steps, missing):
    found = list(meaning_checks.not_close(action_grammar.check(program(steps), knowledge)[0], knowledge))
    assert [(one.step, print_step(one.before[0])) for one in found] == missing


def test_a_program_that_does_nothing():
    found = meaning_checks.without_effect(program("[Walk] <bed> (1)\n[Find] <cup> (1)\n"), default())
    assert [one.code for one in found] == ["NO_EFFECT"]
    assert not list(meaning_checks.without_effect(program("[Walk] <bed> (1)\n[Lie] <bed> (1)\n"), default()))


@pytest.mark.parametrize(
    ("description", "is_off"),
    [("I turn the TV on.", False), ("Wash the dishes well.", True), ("Two televisions", False), ("", False)],
)
def test_words_about_other_things(knowledge, description, is_off):
    given = program("[Walk] <television> (1)\n[SwitchOn] <television> (1)\n", "Relax", description)
    assert bool(list(topics.off_topic(given, knowledge))) == is_off


@pytest.mark.parametrize(
    ("steps", "title", "description", "is_off"),
    [
        ("[Wash] <plate> (1)", "Kitchen", "Do the plates.", False),  # a plural
        ("[Touch] <chessboard> (1)", "Play", "A game of chess.", False),  # a part of the word
        ("[SwitchOn] <laptop> (1)", "Work", "Sit at the computer.", False),  # of the same kind
        ("[Grab] <milk> (1)", "Tidy", "Look into the fridge.", False),  # where it is kept
        ("[SwitchOn] <laptop> (1)", "Iron", "Iron the shirts.", True),
    ],
)
def test_words_related_to_a_thing_without_its_name(knowledge, steps, title, description, is_off):
    given = action_grammar.check(program(steps + "\n", title, description), knowledge)[0]
    assert bool(list(topics.off_topic(given, knowledge))) == is_off


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("Order now and get 15% off! Visit our store.", "advertising"),
        ("Very good HIT, thanks!", "a message to the requester"),
        ("Order a pizza by phone and thank the man who brings it.", None),
        ("I do my homework. The task is easy. Then I visit my friend's web site.", None),
        ("Save the leftovers in the fridge, click the light off.", None),
    ],
)
def test_texts_that_are_not_activities(text, kind):
    found = topics.no_activity(text)
    assert (found[0] if found else None) == kind


def test_going_is_an_effect_where_the_title_says_so():
    assert not list(meaning_checks.without_effect(program("[Run] <kitchen> (1)\n", "Running in circles"), default()))


def test_lamps_and_associated_things_are_within_reach(knowledge):
    for steps in ("[Walk] <bedroom> (1)\n[SwitchOn] <light> (1)\n", "[Walk] <bathtub> (1)\n[SwitchOn] <faucet> (1)\n"):
        assert not list(meaning_checks.not_close(action_grammar.check(program(steps), knowledge)[0], knowledge))


def test_what_was_declared(knowledge):
    given = program("[Walk] <kitchen> (1)\n[Walk] <table> (1)\n[Grab] <cup> (1)\n[Wash] <teeth> (1)\n")
    row = {"rooms": [{"name": "bedroom", "quantity": 1}], "props": [{"name": "cup", "quantity": 2}]}
    messages = [one.message for one in meaning_checks.undeclared(given, row, knowledge)]
    assert len(messages) == 3
    assert "table" in messages[0] and "cup" in messages[1] and "kitchen" in messages[2]
    assert not list(meaning_checks.undeclared(given, {"rooms": [], "props": None}, knowledge))


def test_through_validate(write, built):
    good = "Watch TV\nTV!\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"
    twice = good + "[SwitchOn] <television> (1)\n"
    afar = "Nap\nOn the sofa.\n\n[Walk] <bedroom> (1)\n[Sit] <sofa> (1)\n"
    build = built(write("a.txt", f"{good}\n{twice}\n{afar}"))
    build.run("ingest", "validate")
    assert build.codes("validate") == [("text:a.txt#2", "CONTRADICTION")]
    warnings = {row["program_id"]: [one["code"] for one in row["warnings"]] for row in build.rows("validate")}
    assert warnings == {"text:a.txt": [], "text:a.txt#3": ["NOT_CLOSE"]}
