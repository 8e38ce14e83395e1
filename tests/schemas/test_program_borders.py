"""Borders of programs: a title without steps is distinguished from its neighbour."""

import pytest

from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_program, parse_programs

STEPS = "[Walk] <cup> (1)\n"


def titles(text):
    return [program.title for program in parse_programs(text, "a.txt").programs]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (f"One\nDo one.\n\n\nTwo\nDo two.\n\n\n{STEPS}", ["One", "Two"]),
        (f"One\nDo one.\n\nTwo\nDo two.\n\n{STEPS}", ["One", "Two"]),
        (f"One\n\n\nTwo\n\n\n{STEPS}", ["One", "Two"]),
        (f"{STEPS}\nTwo\n\n\nThree\n\n\n{STEPS}", ["", "Two", "Three"]),
        (f"One\n\nA description after one blank line\n\n{STEPS}", ["One"]),
        (f"One\n\n\nA description after two blank lines.\n\n\n{STEPS}", ["One"]),
        (f"One\nFirst part.\n\nSecond part.\n\n\n{STEPS}", ["One"]),
    ],
)
def test_titles(text, expected):
    assert titles(text) == expected


def test_the_one_without_steps_is_a_fault_at_its_title():
    parsed = parse_programs(f"{STEPS}\n  Two\nDo two.\n\n\nThree\n\n\n{STEPS}", "a.txt")
    (fault,) = parsed.diagnostics
    assert (fault.code, fault.line, fault.column, fault.found) == (Code.EMPTY, 3, 3, "Two")
    assert [len(program.steps) for program in parsed.programs] == [1, 0, 1]


def test_where_one_program_is_meant_blank_lines_in_its_header_part_nothing():
    program, faults = parse_program(f"One\n\n\nA short description\n\n\n{STEPS}")
    assert (program.title, program.description, faults) == ("One", "A short description", ())
