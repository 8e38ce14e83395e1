from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hearth.schemas.program import ObjectRef, Step
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.lcs import LEVELS, LcsScore, items, lcs_signature, matrix, score, score_pairs, similarity

refs = st.builds(
    ObjectRef, st.sampled_from(["cup", "coffee_table", "tv"]), st.integers(1, 2), st.sampled_from([None, 7])
)
steps = st.builds(
    Step,
    st.sampled_from(["Walk", "Grab", "PutBack"]),
    st.lists(refs, max_size=2).map(tuple),
    st.sampled_from([0, 0, 0, 1]),
)
programs = st.lists(st.one_of(steps, st.sampled_from(["sit down", "Sit Down"])), max_size=9).map(tuple)
levels = st.sampled_from(LEVELS)


def unbound(lines):
    return tuple(
        line if isinstance(line, str) else replace(line, objects=tuple(replace(ref, node=None) for ref in line.objects))
        for line in lines
    )


def naive(a, b, level, instances):
    """Eq. 4.1 as it is written: the table of longest common subsequences of all prefixes."""
    if instances and (a == unbound(a) or b == unbound(b)):
        a, b = unbound(a), unbound(b)
    a, b = items(a, level, instances), items(b, level, instances)
    table = [[0] * (len(b) + 1) for _ in range(len(a) + 1)]
    for i, x in enumerate(a):
        for j, y in enumerate(b):
            table[i + 1][j + 1] = table[i][j] + 1 if x == y else max(table[i][j + 1], table[i + 1][j])
    return table[-1][-1] / max(len(a), len(b)) if a or b else 1.0


@given(programs, programs, levels, st.booleans())
def test_equals_the_naive_table(a, b, level, instances):
    assert similarity(a, b, level, instances) == naive(a, b, level, instances)


@settings(max_examples=50)
@given(programs, programs, levels)
def test_is_symmetric_bounded_and_one_only_for_equals(a, b, level):
    found = similarity(a, b, level)
    assert 0 <= found <= 1
    assert found == similarity(b, a, level)
    assert (found == 1) == (items(a, level) == items(b, level))


@settings(max_examples=50)
@given(programs, programs)
def test_telling_instances_apart_never_raises_a_score(a, b):
    assert similarity(a, b, "step", instances=True) <= similarity(a, b, "step")


@settings(max_examples=20)
@given(st.lists(st.tuples(programs, programs), max_size=4), st.booleans())
def test_many_pairs_score_as_each_alone(pairs, instances):
    assert score_pairs(pairs, instances) == [score(a, b, instances) for a, b in pairs]


@settings(max_examples=20)
@given(st.lists(programs, max_size=4), st.lists(programs, max_size=4), levels)
def test_the_matrix_holds_every_pair(rows, columns, level):
    found = matrix(rows, columns, level, workers=1)
    expected = [[similarity(a, b, level) for b in columns] for a in rows]
    assert found.shape == (len(rows), len(columns))
    assert found.dtype == np.float32
    assert np.array_equal(found, np.array(expected, dtype=np.float32).reshape(found.shape))


def test_the_matrix_of_a_list_with_itself():
    lines = [read(["[Walk] <cup> (1)"]), (), read(["[Walk] <cup> (1)", "[Grab] <cup> (1)"])]
    assert matrix(lines, lines).tolist() == [[1, 0, 0.5], [0, 1, 0], [0.5, 0, 1]]


FIGURE_4_7_FIRST = (
    "Walk fridge, Open fridge, Walk oven, Open oven, Walk fridge, Close fridge, Walk sofa, Sit sofa, StandUp, "
    "Walk oven, Open oven, Close oven"
)
FIGURE_4_7_THIRD = (
    "Walk oven, Open oven, Close oven, Walk alarm_clock, Grab alarm_clock, Walk table, PutBack alarm_clock table, "
    "Walk knife, Grab knife",
    "Walk oven, Open oven, Close oven, Walk toy, Grab toy, Walk table, PutBack toy table",
)


def lines_of(short):
    steps = [step.split() for step in short.split(", ")]
    return read([f"[{step[0]}] " + " ".join(f"<{name}> (1)" for name in step[1:]) for step in steps])


@pytest.mark.parametrize(
    ("reference", "predicted", "printed"),
    [(FIGURE_4_7_FIRST, FIGURE_4_7_FIRST.replace("sofa", "couch"), "0.833"), (*FIGURE_4_7_THIRD, "0.444")],
)
def test_the_thesis_examples(reference, predicted, printed):
    """Thesis figure 4-7. Its second example (0.600) is left out: the steps as printed there give 8/12."""
    assert f"{similarity(lines_of(predicted), lines_of(reference)):.3f}" == printed


def test_levels_and_mean():
    predicted = read(["[Walk] <cup> (1)", "[Grab] <cup> (1)", "[PutIn] <cup> (1) <sink> (1)"])
    reference = read(["[Walk] <cup> (1)", "[Grab] <plate> (1)", "[PutBack] <cup> (1) <sink> (1)"])
    found = score(predicted, reference)
    assert found == LcsScore(1 / 3, 2 / 3, 3 / 4)  # objects: cup cup cup sink, cup plate cup sink
    assert found.mean == pytest.approx((1 / 3 + 2 / 3 + 3 / 4) / 3)


@pytest.mark.parametrize("level", LEVELS)
def test_two_empty_programs_score_one_and_one_empty_zero(level):
    filled = read(["[Walk] <cup> (1)"])
    assert similarity((), (), level) == 1
    assert similarity(filled, (), level) == similarity((), filled, level) == 0


def test_spelling_of_names_does_not_matter():
    assert similarity(read(["[SWITCHON] <Coffee Table> (1)"]), read(["[Switch On] <coffee_table> (1)"])) == 1


def test_order_of_objects_matters():
    a, b = read(["[PutBack] <cup> (1) <table> (1)"]), read(["[PutBack] <table> (1) <cup> (1)"])
    assert similarity(a, b) == 0
    assert similarity(a, b, "object") == 0.5


def test_instances_count_only_when_asked():
    a, b = read(["[Grab] <cup> (1)"]), read(["[Grab] <cup> (2)"])
    assert similarity(a, b) == 1
    assert similarity(a, b, instances=True) == 0
    bound = read(["[Grab] <cup> (1.41)"])
    assert similarity(bound, read(["[Grab] <cup> (2.41)"]), instances=True) == 1
    assert similarity(bound, read(["[Grab] <cup> (1.42)"]), instances=True) == 0
    # A program that names no node is compared by its numbers.
    assert (similarity(bound, a, instances=True), similarity(b, bound, instances=True)) == (1, 0)


def test_another_agents_step_is_another_step():
    a, b = read(["<char1> [Walk] <cup> (1)"]), read(["[Walk] <cup> (1)"])
    assert (similarity(a, b), similarity(a, b, "action")) == (0, 1)


def test_text_is_compared_as_text():
    assert similarity(("Stand up", "go"), ("stand UP", "come")) == 0.5
    assert similarity(("[Walk <cup>",), read(["[Walk] <cup> (1)"]), "action") == 0


def test_signature():
    assert lcs_signature() == "lcs|norm:max|level:step|v1"
    assert lcs_signature("action", instances=True) == "lcs|norm:max|level:action|instances:named|v1"
