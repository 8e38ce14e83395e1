"""The ideal reader: right wherever all is mentioned, no better than the likeliest program where nothing is."""

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.analysis import synthesis, synthesis_splits
from hearth.analysis.description_information import Reading, figures, ideal, mean_lcs, unsaid
from hearth.analysis.synthesis import Part, Weighted


@pytest.fixture(scope="module")
def grammar(knowledge):
    return synthesis.load(synthesis.FILE, knowledge)


@pytest.fixture(scope="module")
def drawn(grammar):
    return list(synthesis.synthesize(300, 7, grammar))


def with_parts(grammar, **changes):
    """The grammar with other chances of its parts."""
    tasks = {
        name: replace(task, parts=tuple(replace(part, **changes) for part in task.parts))
        for name, task in grammar.tasks.items()
    }
    return replace(grammar, tasks=tasks)


def test_who_reads_of_every_part_writes_every_action(grammar):
    everything = with_parts(grammar, described=1.0)
    for one in synthesis.synthesize(100, 1, everything):
        found = ideal(Reading(one, 0), everything)
        assert [action for action, _ in found.steps] == [action for action, _ in one.steps]


def test_who_reads_of_every_part_in_clauses_that_name_all_writes_the_program(grammar):
    tasks = {
        name: replace(
            task,
            parts=tuple(
                replace(part, described=1.0, say=(" ".join(f"the {{{slot}}}" for slot in task.slots) or "do it",))
                for part in task.parts
            ),
        )
        for name, task in grammar.tasks.items()
    }
    naming = replace(grammar, tasks=tasks)
    programs = list(synthesis.synthesize(100, 1, naming))
    assert mean_lcs([Reading(one, 0) for one in programs], naming) == 1


def test_the_more_is_mentioned_the_better(grammar):
    def of(described):
        weights = with_parts(grammar, described=described)
        return mean_lcs([Reading(one, 0) for one in synthesis.synthesize(300, 2, weights)], weights)

    assert of(0.1) < of(0.5) < of(0.9)


def test_a_task_that_is_not_mentioned_is_left_out_unless_the_title_names_it(grammar, drawn):
    one = next(each for each in drawn if len(each.tasks) == 2)
    silent = replace(one, mentioned=((),))
    found = ideal(Reading(silent, 0), grammar)
    again = ideal(Reading(replace(silent, tasks=one.tasks[:1]), 0), grammar)
    assert found.steps == again.steps != ()


def test_what_is_mentioned_does_not_depend_on_the_program(drawn, grammar):
    """The reader sees what clauses mention, and nothing else: other true steps change nothing."""
    one = drawn[0]
    other = replace(one, steps=(("StandUp", ()),))
    assert ideal(Reading(one, 0), grammar).steps == ideal(Reading(other, 0), grammar).steps


@given(st.floats(0, 1), st.floats(0, 1))
def test_an_unsaid_part_is_as_likely_as_counting_says(chance, described):
    part = Part((), (), chance, described)
    silent, without = chance * (1 - described), 1 - chance
    assert unsaid(part) == pytest.approx(silent / (silent + without) if silent else 0)


def test_the_likeliest_is_the_first_with_the_greatest_weight():
    assert Weighted.of({"cup": 1, "glass": 3, "mug": 3}).likeliest == "glass"


@pytest.mark.parametrize("other", [0.1, 0.2, 0.6, 0.9])
def test_other_thresholds_are_not_better(drawn, grammar, monkeypatch, other):
    asked = [Reading(one, 0) for one in drawn]
    usual = mean_lcs(asked, grammar)
    monkeypatch.setattr("hearth.analysis.description_information.LIKELY", other)
    assert mean_lcs(asked, grammar) < usual + 0.01


def test_figures_are_of_all_and_of_the_test_of_each_split(drawn, grammar):
    rows = synthesis_splits.splits(drawn, 7)
    found = figures(drawn, rows, grammar)
    assert set(found) == {"all", *synthesis_splits.SPLITS}
    assert all(0.6 < value < 0.95 for value in found.values()), "descriptions leave out half of the parts"
    pairs = [row.program for row in rows if (row.split, row.part, row.description) == ("pairs", "test", 0)]
    assert found["pairs"] == round(mean_lcs([Reading(drawn[number - 1], 0) for number in pairs], grammar), 3)
    assert Weighted.of({"cup": 0.1, "glass": 0.1, "mug": 0.1}).likeliest == "cup"
