"""Columns of programs say what a dictionary of them says."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hearth.datasets.format.split_columns import NOTHING, PARTS, SHORTEST_TEXT, SplitProgram, SplitPrograms, normalised
from hearth.datasets.format.split_runs import Runs

LONG = (
    "She reads her novel by the lamp.",
    "SHE reads  her novel by the lamp.",
    "He washes all of the plates.",
    "Short",
)

names = st.text("ab\u00e9:", min_size=1, max_size=3)


@st.composite
def forests(draw):
    """Programs in any order, some of them twice; a parent comes earlier in the alphabet, and need not be there."""
    found = []
    for name in draw(st.lists(names, max_size=12)):
        parent = draw(st.none() | st.sampled_from(["", "0", *(each.program_id for each in found)]))
        known = {each.program_id: each for each in found}
        again = known.get(name)
        above = parent if parent is not None and parent < name else None
        steps = tuple(draw(st.lists(st.sampled_from(["w x", "g y", "p"]), max_size=3)))
        fresh = SplitProgram(name, "a", draw(st.sampled_from(["", *PARTS])), above, steps, draw(st.sampled_from(LONG)))
        found.append(again or fresh)
    return found


def plainly(programs):
    """For each id: whether it is a program, its root, its part, and what is compared of it."""
    first = {}
    for each in programs:
        first.setdefault(each.program_id, each)

    def root(name):
        return root(first[name].parent) if name in first and first[name].parent is not None else name

    found = {}
    for name in sorted({*first, *(each.parent for each in first.values() if each.parent is not None)}):
        each = first.get(name)
        text = normalised(each.description) if each else ""
        part = PARTS.index(each.part) if each and each.part else NOTHING
        steps = each.steps if each else ()
        found[name] = (each is not None, root(name), part, steps, text if len(text) >= SHORTEST_TEXT else "")
    return found


def alike(values):
    """(values, values) which are equal and neither empty."""
    return [[bool(one) and one == other for other in values] for one in values]


@given(forests())
def test_columns_are_those_of_a_dictionary(programs):
    wanted, found = plainly(programs), SplitPrograms.of(iter(programs))
    assert list(found.ids) == list(wanted)
    known, roots, parts, steps, texts = zip(*wanted.values(), strict=True) if wanted else [()] * 5
    assert tuple(found.known.tolist()) == known
    assert tuple(found.ids[place] for place in found.root) == roots
    assert tuple(found.part.tolist()) == parts
    for near, values in ((found.steps, steps), (found.texts, texts)):
        same = near.numbers[:, None] == near.numbers
        assert (same & (near.numbers != NOTHING)).tolist() == alike(values)
    assert [found.place(name) for name in wanted] == list(range(len(wanted)))


@given(
    st.lists(st.tuples(names, st.integers(0, 3), st.sampled_from(["elm", "oak", "ash"])), unique_by=lambda run: run[0])
)
def test_runs_are_in_the_order_of_their_ids(runs):
    programs = SplitPrograms.of(SplitProgram(f"p{number}", "a", "", None, ("s",), "") for number in range(4))
    rows = [(name, f"p{number}", home) for name, number, home in runs]
    found = Runs(programs, iter(rows))
    assert list(found) == list(found) == sorted(runs)
    assert found.homes == sorted({home for _, _, home in runs})
    assert programs.root.dtype == np.int32
