import pytest

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_steps
from hearth.scoring.line_sequences import read, steps_of

WALK = Step("Walk", (ObjectRef("sofa"),))
SIT = Step("Sit", (ObjectRef("sofa"),))


def test_title_and_description_are_no_lines():
    assert read("Watch TV\nSit down and watch.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n") == (WALK, SIT)


def test_a_list_of_steps_has_no_title():
    assert read(["Watch TV", "[Walk] <sofa> (1)", "", SIT]) == ("Watch TV", WALK, SIT)


def test_what_does_not_parse_stays_as_text_where_it_stood():
    text = "[Walk] <sofa> (1)\nthen   sit\n[Sit <sofa> (1)\n[Special] <x>\n[Sit] <sofa> (1)"
    assert read(text) == (WALK, "then sit", "[Sit <sofa> (1)", "[Special] <x>", SIT)


def test_text_without_steps_is_all_lines():
    assert read("Walk to sofa\n\nSit on sofa\n") == ("Walk to sofa", "Sit on sofa")


@pytest.mark.parametrize("empty", ["", "\n \n", [], ["", " "], Program("Watch TV")])
def test_nothing_is_no_lines(empty):
    assert read(empty) == ()


def test_two_agents_in_a_line_are_two_steps():
    lines = read("<char0> [Walk] <sofa> (1) | <char1> [StandUp]")
    assert [(step.action, step.agent, step.joins) for step in lines] == [("Walk", 0, False), ("StandUp", 1, True)]


def test_another_reader_reads_other_words():
    def words(line):
        if line.startswith("["):
            return parse_steps(line)
        action, _, name = line.partition(" to ")
        return (Step(action, (ObjectRef(name),)),) if name else Diagnostic(Code.SYNTAX, "no")

    assert read("Sit down\nWalk to sofa\nrest", words) == (WALK, "rest")
    assert steps_of(read("Sit down\nWalk to sofa\nrest", words)) == (WALK,)
    assert len(read("Walk to sofa\nSit down\n\n[Walk] <sofa> (1)", words)) == 1  # a title that reads like a step
