import pytest

from hearth.pipelines.checks.text_checks import check_text
from hearth.schemas.failures import Code
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.parsability import parsability


@pytest.mark.parametrize(
    ("line", "code", "found"),
    [
        ("walk to the sofa", Code.SYNTAX, "walk to the sofa"),
        ("[Fly] <sofa> (1)", Code.UNKNOWN_ACTION, "Fly"),
        ("[Sleep] <television> (1)", Code.WRONG_ARITY, "1 of 0"),  # the thesis's own example, A.3
        ("[PutBack] <cup> (1)", Code.WRONG_ARITY, "1 of 2"),
        ("[Walk] <phlogiston> (1)", Code.UNKNOWN_OBJECT, "phlogiston"),
        ("[PutBack] <phlogiston> (1)", Code.WRONG_ARITY, "1 of 2"),
    ],
)
def test_the_gravest_fault_of_a_line(knowledge, line, code, found):
    result = parsability(read(["[Walk] <sofa> (1)", line]), knowledge)
    (fault,) = result.faults
    assert (fault.line, fault.code, fault.found) == (1, code, found)
    assert result.parsable == (code is Code.UNKNOWN_OBJECT)
    assert not result.named


def test_counts(knowledge):
    lines = read(["[Walk] <sofa> (1)", "[Walk] <phlogiston> (1)", "sit"])
    result = parsability(lines, knowledge)
    assert (result.lines, result.arity, result.names) == (3, 2, 1)


def test_an_affordance_is_not_asked_about(knowledge):
    assert parsability(read(["[Grab] <bedroom> (1)"]), knowledge).named  # invalid only to execute, A.3


def test_an_empty_program_does_not_parse(knowledge):
    """Nothing was answered: a model that says nothing to a third of the tasks got the score of that third."""
    found = parsability((), knowledge)
    assert (found.parsable, found.named, found.faults) == (False, False, ())


@pytest.mark.parametrize(
    "line",
    [
        "[PUTBACK] <television> (1) <television> (1)",
        "[PutBack] <television> (1) <Television> (1)",
        "[putin] <TV> (2) <television> (2)",
        "[PutIn] <cup> (1.20) <cup> (1.20)",
    ],
)
def test_an_object_given_twice_is_the_wrong_number_of_objects(knowledge, line):
    (fault,) = parsability(read([line]), knowledge).faults
    assert fault.code is Code.WRONG_ARITY
    assert [each.code for each in check_text(line, knowledge).faults] == [Code.WRONG_ARITY]


def test_two_of_a_class_are_two_objects(knowledge):
    assert parsability(read(["[PutBack] <cup> (1) <cup> (2)"]), knowledge).named


def test_spelling_as_grounded_programs_have_it(knowledge):
    assert parsability(read(["[SWITCHON] <Television> (1.12)"]), knowledge).named
