"""The executions that are pictured from above."""

from __future__ import annotations

from hearth.pipelines.engine.executions_for_demonstrations import chosen

RAN = [(f"p{number}", f"p{number}@{home}", home) for number in range(40) for home in ("maple", "birch", "other")]
HOMES = ("maple", "birch")


def test_one_execution_of_each_drawn_program_home_by_home():
    found = chosen(RAN, HOMES, 12, 0)
    programs = [name.split("@")[0] for name in found]
    homes = [name.split("@")[1] for name in found]
    assert len({*programs}) == len(found) == 12
    assert homes == sorted(homes) and {*homes} == {*HOMES}


def test_the_seed_draws_and_the_order_of_runs_does_not_matter():
    assert chosen(RAN, HOMES, 12, 0) == chosen(RAN[::-1], HOMES, 12, 0)
    assert chosen(RAN, HOMES, 12, 0) != chosen(RAN, HOMES, 12, 1)


def test_more_programs_keep_those_of_fewer():
    assert {*chosen(RAN, HOMES, 12, 0)} < {*chosen(RAN, HOMES, 30, 0)}
    assert len(chosen(RAN, HOMES, 99, 0)) == 40
    assert chosen(RAN, HOMES, 0, 0) == []
