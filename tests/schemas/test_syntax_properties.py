"""The syntax: what is printed is read back, what is canonical is printed unchanged, and nothing is passed over."""

from hypothesis import given, settings
from hypothesis import strategies as st

from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program, parse_programs, parse_steps, print_program, print_step
from hearth.schemas.text_decoding import decode

WORD = st.text("abz09", min_size=1, max_size=3)
NAME = st.lists(WORD, min_size=1, max_size=3).map("_".join)
ACTION = st.lists(st.sampled_from(["Put", "Back", "Walk", "Zz", "Aspecial"]), min_size=1, max_size=3).map("".join)
NUMBER = st.integers(0, 999_999_999)
REF = st.builds(ObjectRef, NAME, NUMBER.filter(bool)) | st.builds(ObjectRef, NAME, NUMBER, NUMBER)
MODIFIER = st.tuples(st.text("az", min_size=1, max_size=3), st.text("aZ09.,:=-", min_size=1, max_size=4))
LINE = st.text(st.characters(exclude_categories=["Cc", "Cs", "Zl", "Zp"]), max_size=20).map(
    lambda text: f"x{text}".rstrip()
)
FEW = settings(max_examples=50)


@st.composite
def programs(draw):
    """Canonical programs: a title where there is a description, ticks of one or several agents."""
    title = draw(LINE | st.just(""))
    description = "\n".join(draw(st.lists(LINE, max_size=3))) if title else ""
    agents = draw(st.sampled_from([1, 1, 3, 1000]))
    steps = []
    for size in draw(st.lists(st.integers(1, 3 if agents > 1 else 1), min_size=1, max_size=6)):
        for place in range(size):
            agent = draw(st.integers(0, agents - 1))
            objects = tuple(draw(st.lists(REF, max_size=3)))
            modifiers = tuple(draw(st.lists(MODIFIER, max_size=2)))
            steps.append(Step(draw(ACTION), objects, agent, place > 0, modifiers))
    return Program(title, description, tuple(steps))


@FEW
@given(programs())
def test_reading_back_what_was_printed_gives_the_program(program):
    read, faults = parse_program(print_program(program))
    assert faults == ()
    assert read == program


@FEW
@given(programs())
def test_printing_what_was_read_gives_canonical_text_unchanged(program):
    text = print_program(program)
    assert print_program(parse_program(text)[0]) == text


@FEW
@given(st.lists(programs().filter(lambda program: program.title), min_size=1, max_size=3))
def test_programs_one_after_another_stay_apart(several):
    parsed = parse_programs("\n".join(map(print_program, several)))
    assert parsed.diagnostics == ()
    assert list(parsed.programs) == several


@FEW
@given(programs())
def test_lines_say_where_each_step_stood(program):
    text = print_program(program)
    read, _ = parse_program(text)
    source = text.split("\n")
    for number, step in enumerate(read.steps):
        assert print_step(step, show_agent=program.agents() > 1) in source[read.line(number) - 1]


SCRAPS = st.sampled_from([
    "[Walk]", "[", "]", "<cup>", "<", ">", "(1)", "(1.41)", "(", ")", "(x)", "|", "<char1>", "{at=3,2}", "{", "}",
    "cup", "[Special]", "“", "茶", " ", "\t", "Watch TV", "\n", "\n\n", "\u2028", "\x00", "0" * 12,
])  # fmt: skip
MESS = st.lists(SCRAPS | st.text(max_size=5), max_size=25).map("".join)


@given(MESS)
def test_no_line_vanishes(text):
    """Every line that is not blank is a title, part of a description, steps, or named by a diagnostic."""
    parsed = parse_programs(text)
    lines = text.split("\n")
    heads = sum(len([line for line in (each.title, *each.description.split("\n")) if line]) for each in parsed.programs)
    steps = {line for program in parsed.programs for line in program.lines}
    faulty = {fault.line for fault in parsed.diagnostics if fault.line and fault.code != Code.EMPTY}
    assert not steps & faulty
    assert heads + len(steps | faulty) == sum(bool(line.strip()) for line in lines)


@given(MESS)
def test_every_fault_has_a_code_a_place_and_a_remedy(text):
    lines = text.split("\n")
    for fault in parse_programs(text, "some.txt").diagnostics:
        assert fault.code and fault.message and fault.suggestion and fault.file == "some.txt"
        if fault.line:
            source = lines[fault.line - 1]
            assert fault.source == source[:200]
            assert 1 <= fault.column <= len(source) + 1
            assert fault.found == source[fault.column - 1 :][: len(fault.found)]


@given(MESS.map(lambda text: " ".join(text.split("\n"))))
def test_a_line_is_steps_or_a_fault_and_steps_print_as_they_were_meant(line):
    found = parse_steps(line)
    if not isinstance(found, Diagnostic):
        assert found
        several = " | ".join(print_step(step, show_agent=True) for step in found)
        assert parse_steps(several) == found


@given(st.binary(max_size=200))
def test_any_bytes_are_text_or_a_fault(data):
    found = decode(data, "some.txt")
    if isinstance(found, Diagnostic):
        assert found.suggestion and found.file == "some.txt"
    else:
        assert "\r" not in found and "\x00" not in found


@given(st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\x00\r\ufeff"), max_size=60))
def test_editors_encodings_give_the_same_text(text):
    for encoding in ("utf-8", "utf-8-sig", "utf-16"):
        assert decode(text.replace("\n", "\r\n").encode(encoding)) == text
