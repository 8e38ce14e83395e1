"""The executions that are filmed for clips: parts of programs and homes."""

from __future__ import annotations

from collections import Counter

from hypothesis import given
from hypothesis import strategies as st

from hearth.pipelines.engine.executions_for_clips import (
    SEEN,
    TEST,
    TRAIN,
    UNSEEN,
    VALIDATION,
    chosen,
    home_kinds,
    part_of,
)
from hearth.pipelines.render import prepare

HOMES = ("a", "b", "c", "d", "e", "f", "g")


def ran(count, homes=HOMES):
    return [(f"p{n}", f"p{n}@{home}", home) for n in range(count) for home in homes]


def steps(count, different=0):
    """The steps of programs: of each others, or of as many different ones as are named."""
    return {f"p{n}": str(n % (different or count)) for n in range(count)}


def test_the_last_two_homes_are_never_seen():
    assert [home_kinds(HOMES)[home] for home in HOMES] == [SEEN] * 4 + [VALIDATION] + [UNSEEN] * 2
    assert [*home_kinds(("a", "b")).values()] == [SEEN, UNSEEN]
    assert [*home_kinds(("a",)).values()] == [SEEN]


@given(st.integers(0, 1_000), st.integers(1, 200))
def test_a_program_is_in_one_part_and_training_in_seen_homes(seed, count):
    found = chosen(ran(count), steps(count), HOMES, count, seed)
    assert len(found) == count
    programs = [execution.split("@")[0] for execution in found]
    assert len({*programs}) == count
    for execution, (part, kind) in found.items():
        program, home = execution.split("@")
        assert part == part_of(program, seed)
        assert kind == home_kinds(HOMES)[home]
        assert kind == SEEN if part == TRAIN else part == TEST or kind == VALIDATION


def test_tests_are_in_all_kinds_of_homes_and_parts_have_their_shares():
    found = chosen(ran(2_000), steps(2_000), HOMES, 2_000, 3)
    parts = Counter(part for part, _ in found.values())
    assert abs(parts[TRAIN] / 2_000 - 0.7) < 0.04 and abs(parts[TEST] / 2_000 - 0.2) < 0.04
    kinds = Counter(kind for part, kind in found.values() if part == TEST)
    assert min(kinds.values()) > 0.1 * parts[TEST] and kinds[UNSEEN] > 0.3 * parts[TEST]


def test_a_program_that_ran_nowhere_it_may_be_filmed_is_left_out():
    found = chosen(ran(50, ("f",)), steps(50), HOMES, 50, 0)
    assert found.keys() == {f"p{n}@f" for n in range(50) if part_of(f"p{n}", 0) == TEST}


def test_the_order_of_runs_changes_nothing():
    runs = ran(40)
    for of in (steps(40), steps(40, 9)):
        assert chosen(runs, of, HOMES, 40, 1) == chosen([*reversed(runs)], of, HOMES, 40, 1)


@given(st.integers(0, 1_000), st.integers(1, 30), st.integers(1, 4))
def test_programs_of_the_same_steps_are_in_one_part(seed, different, each):
    """A program of a test under another id is not filmed for training."""
    count = different * each
    of = steps(count, different)
    found = chosen(ran(count), of, HOMES, count, seed)
    parts = {(of[execution.split("@")[0]], part) for execution, (part, _) in found.items()}
    assert len(found) == count and len(parts) == different


def test_a_build_parts_programs_by_their_steps(built, write):
    """Two step lists under twelve ids, in one home, which is seen in training."""
    sources = [
        write(f"{number}.txt", f"Errand {number}\nIt is done.\n\n[Walk] <fridge> (1)\n[{action}] <fridge> (1)\n")
        for number, action in enumerate(("Open", "TurnTo") * 6)
    ]
    made = built(*sources, homes=("maple",), homes_folder=None, variants=0, clips=12)
    made.run("ingest", "validate", "sample")
    of = {row["execution_id"]: row["steps"][1]["action"] for row in made.rows("sample")}
    clips = prepare(made.settings)["clips"]
    assert len(clips) == 12 and len({(of[name], part) for name, (part, _) in clips.items()}) == 2
