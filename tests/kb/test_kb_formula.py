"""Formulas as text: how deep parts may stand within one another."""

import pytest

from hearth.kb.formula import parse_effect, parse_formula
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.tokens import DEEPEST

NESTED = {"brackets": ("(", ")"), "not": ("not ", ""), "some": ("some x: ", ""), "count": ("count x: ", " < limit(o)")}


@pytest.mark.parametrize("kind", NESTED)
def test_parts_stand_in_one_another_up_to_a_limit(kind):
    opening, closing = NESTED[kind]
    assert parse_formula(DEEPEST * opening + "open(o)" + DEEPEST * closing)
    for depth in (DEEPEST + 1, 20_000):
        with pytest.raises(HearthError, match=f"SYNTAX.*more than {DEEPEST} parts within one another"):
            parse_formula(depth * opening + "open(o)" + depth * closing)


def test_effects_within_effects_have_the_same_limit():
    deep = "for x: open(x) -> "
    assert parse_effect(DEEPEST * deep + "open(o)")
    with pytest.raises(HearthError, match=f"SYNTAX.*more than {DEEPEST}"):
        parse_effect(5_000 * deep + "open(o)")


def test_parts_beside_one_another_have_no_limit():
    assert len(parse_formula(" & ".join(["(open(o) | open(o))"] * 200)).parts) == 200
