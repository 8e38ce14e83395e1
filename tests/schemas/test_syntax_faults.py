"""Each way in which a line can be malformed: its code, its column, the words found, and a remedy."""

import pytest

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.syntax import MAX_LINE, parse_program, parse_programs, parse_steps

FAULTS = [
    ("[Walk] <cup> (one)", Code.BAD_INSTANCE, 15, "one"),
    ("[Walk] <cup> ()", Code.BAD_INSTANCE, 15, ""),
    ("[Walk] <cup> (1.x)", Code.BAD_INSTANCE, 15, "1.x"),
    ("[Walk] <cup> (-1)", Code.BAD_INSTANCE, 15, "-1"),
    ("[Walk] <cup> (1.)", Code.BAD_INSTANCE, 15, "1."),
    ("[Walk] <cup> (1234567890)", Code.BAD_INSTANCE, 15, "1234567890"),
    ("[PutBack] <cup> (1) <table> (a)", Code.BAD_INSTANCE, 30, "a"),
    ("<char0> [Walk] <cup> (1) | <char1> [Walk] <cup> (b)", Code.BAD_INSTANCE, 50, "b"),
    ("[Walk <cup> (1)", Code.SYNTAX, 1, "[Walk <cup> (1)"),
    ("Walk] <cup> (1)", Code.SYNTAX, 1, "Walk] <cup> (1)"),
    ("walk to the cup", Code.SYNTAX, 1, "walk to the cup"),
    ("<cup> (1)", Code.SYNTAX, 1, "<cup> (1)"),
    ("[W4lk] <cup> (1)", Code.SYNTAX, None, None),
    ("[] <cup> (1)", Code.SYNTAX, 1, "[]"),
    ("[Walk] <> (1)", Code.SYNTAX, 8, "<>"),
    ("[Walk] < _ > (1)", Code.SYNTAX, 8, "< _ >"),
    ("[Walk] cup (1)", Code.SYNTAX, 8, "cup (1)"),
    ("[Walk] <cup (1)", Code.SYNTAX, 8, "<cup (1)"),
    ("[Walk] <cup> 1", Code.SYNTAX, 8, "<cup> 1"),
    ("[Read] <book> (1) quietly", Code.SYNTAX, 19, "quietly"),
    ("<chef> [Walk] <cup> (1)", Code.SYNTAX, 1, "<chef>"),
    ("<char0> [Walk] <cup> (1) |", Code.SYNTAX, 26, "|"),
    ("| [Walk] <cup> (1)", Code.SYNTAX, 1, "| [Walk] <cup> (1)"),
    ("[Walk] <cup> (1) {at=3,2 hand}", Code.SYNTAX, 18, "{at=3,2 hand}"),
    ("[Walk] <cup> (1) {at 3}", Code.SYNTAX, 18, "{at 3}"),
    ("[Walk] <cup> (1) {at=3", Code.SYNTAX, None, None),
    ("[Special] <sing to the cat>", Code.SPECIAL_BLOCK, 1, "[Special] <sing to the cat>"),
    ("[special]", Code.SPECIAL_BLOCK, 1, "[special]"),
    ("[ SPECIAL ] anything at all", Code.SPECIAL_BLOCK, 1, "[ SPECIAL ] anything at all"),
    ("[Walk] " + "<cup> (1) " * 2_000, Code.LINE_TOO_LONG, 1, ""),
]


@pytest.mark.parametrize(("line", "code", "column", "found"), FAULTS, ids=[line[:30] for line, *_ in FAULTS])
def test_a_malformed_line(line, code, column, found):
    fault = parse_steps(line)
    assert isinstance(fault, Diagnostic), fault
    assert fault.code == code
    assert fault.message and fault.suggestion
    if column:
        assert (fault.column, fault.found) == (column, found)
    assert 1 <= fault.column <= len(line) + 1
    assert not line[fault.column - 1].isspace() and fault.found == fault.found.strip()


@pytest.mark.parametrize("line", [line for line, code, *_ in FAULTS])
def test_a_malformed_line_in_a_file_is_placed_and_costs_no_neighbour(line):
    program, faults = parse_program(f"Title\n\n\n[Walk] <cup> (1)\n{line}\n[Find] <cup> (1)\n", "a.txt")
    assert [step.action for step in program.steps] == ["Walk", "Find"]
    assert program.lines == (4, 6)
    (fault,) = faults
    assert (fault.file, fault.line, fault.source) == ("a.txt", 5, line[:200])
    assert str(fault).startswith(f"a.txt:5:{fault.column}: {fault.code}: ")


GOOD = {
    "[Walk] <cup> (1)": "Walk cup 1 None",
    "[walk]<cup>(1)": "walk cup 1 None",
    "  [Walk]   < Coffee  Cup >  ( 1 )  ": "Walk coffee_cup 1 None",
    "[WALK] <coffee_cup> (1.319)": "WALK coffee_cup 1 319",
    "[Put Back] <cup> (1) <table> (2)": "Put Back cup 1 None table 2 None",
    "[put_back] <cup> (1) <table> (2)": "put_back cup 1 None table 2 None",
    "[Walk] <cup> (319)": "Walk cup 319 None",
    "[Sleep]": "Sleep",
}


@pytest.mark.parametrize("line", GOOD)
def test_spellings_that_files_in_the_wild_have(line):
    (step,) = parse_steps(line)
    words = [step.action, *(f"{ref.name} {ref.instance} {ref.node}" for ref in step.objects)]
    assert " ".join(words) == GOOD[line]


def test_agents_and_modifiers():
    first, second = parse_steps("<char0> [Walk] <cup> (1) {at=3,2 hand=left} | <char1> [StandUp]")
    assert (first.agent, second.agent) == (0, 1)
    assert (first.joins, second.joins) == (False, True)
    assert first.modifiers == (("at", "3,2"), ("hand", "left"))


def test_an_empty_text_is_a_fault():
    for text in ("", "\n\n", "   \n\t\n"):
        parsed = parse_programs(text, "a.txt")
        assert parsed.programs == ()
        assert [fault.code for fault in parsed.diagnostics] == [Code.EMPTY]


def test_a_title_without_steps_is_a_fault():
    program, faults = parse_program("Watch TV\nSit and watch.\n", "a.txt")
    assert program.title == "Watch TV"
    assert [fault.code for fault in faults] == [Code.EMPTY]
    assert "Watch TV" in faults[0].message and faults[0].suggestion


def test_a_second_program_where_one_is_wanted_is_a_fault():
    text = "One\n\n\n[Walk] <cup> (1)\n\nTwo\n\n\n[Walk] <bed> (1)\n"
    program, faults = parse_program(text, "a.txt")
    assert program.title == "One" and len(program.steps) == 1
    assert [fault.code for fault in faults] == [Code.SYNTAX]
    assert "Two" in faults[0].message
    assert len(parse_programs(text).programs) == 2


def test_descriptions_may_have_several_lines_or_none():
    program, _ = parse_program("Watch TV\nFirst sit.\nThen watch.\n\n\n[Walk] <cup> (1)\n")
    assert program.description == "First sit.\nThen watch."
    assert parse_program("Watch TV\n\n\n[Walk] <cup> (1)\n")[0].description == ""
    assert parse_program("[Walk] <cup> (1)\n")[0].title == ""


def test_a_line_as_long_as_allowed_is_read():
    filling = "[Walk] <cup> (1)"
    line = filling + " " * (MAX_LINE - len(filling))
    assert len(parse_steps(line)) == 1
    assert parse_steps(line + " ").code == Code.LINE_TOO_LONG


def test_a_hostile_line_takes_no_longer_than_a_plain_one():
    """Nested repetition in a pattern would take for ever here."""
    for scrap in ("<", "<a", "<a> (", "[a ", "<a> (1", "[a] <a> (1) <a> (1"):
        line = ("[Walk] " + scrap * MAX_LINE)[: MAX_LINE - 1]
        assert isinstance(parse_steps(line), Diagnostic)
