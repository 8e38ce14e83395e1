"""The syntax of programs: text to steps and back.

    <char0> [PutBack] <cup> (1.41) <table> (2) {at=3,2 hand=left} | <char1> [StandUp]

An agent is named only where there are several; an instance is `(1)` as collected or `(1.41)` once bound to node 41, and
1 where none is written; modifiers are optional; `|` parts what several agents do in one tick. Names and modifiers are
checked by `hearth.kb.action_grammar`.
The number that VirtualHome prints after a step, `[0]`, and a comment after the steps, `# twice`, are read over.
Printing what was parsed gives canonical text back unchanged.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import lru_cache

from hearth.schemas.diagnostics import Diagnostic, excerpt
from hearth.schemas.failures import Code
from hearth.schemas.malformed_steps import explain, special
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.program_boundaries import STEP, Splitter

MAX_LINE = 10_000
"""Characters a line may have; a longer one is rejected instead of being searched for steps."""

SPECIAL = "special"

_INSTANCE = r"\s*+\(\s*(?!0+\s*\))([0-9]{1,9})(?:\.([0-9]{1,9}))?\s*\)"
_OBJECT = rf"<[\s_]*([^\s_<>\[\]][^<>\[\]]*?)[\s_]*>(?:{_INSTANCE})?"
_STEP = re.compile(
    rf"\s*(?:<\s*char([0-9]{{1,3}})\s*>\s*)?\[\s*([A-Z][A-Z _-]*?)\s*\]\s*((?:{_OBJECT}\s*+)*)(\{{[^{{}}]*\}})?\s*"
    r"(?:\[\s*[0-9]{1,6}\s*\]\s*)?",
    re.IGNORECASE,
)
_OBJECTS = re.compile(_OBJECT)
_REMARK = re.compile(r"(?<=[\])}>])\s*+(?:#|//).*")
"""A comment after the steps of a line."""

_MODIFIER = re.compile(r"([a-z]+)=(\S+)")


@dataclass(frozen=True, slots=True)
class Parsed:
    """The programs of a text as far as they could be read, and every fault."""

    programs: tuple[Program, ...]
    diagnostics: tuple[Diagnostic, ...]


def parse_programs(text: str, file: str = "") -> Parsed:
    """Read every program of a text; a line that is not a step becomes a diagnostic, never a silent loss."""
    return _parse(text, file, several=True)


def _parse(text: str, file: str, several: bool) -> Parsed:
    programs: list[Program] = []
    diagnostics: list[Diagnostic] = []
    for block in _blocks(text, several):
        program, faults = _parse_block(block, file)
        programs.append(program)
        diagnostics.extend(faults)
    if not programs:
        diagnostics.append(
            Diagnostic(
                Code.EMPTY, "nothing to read", file, suggestion="write a title, a blank line, then one [Step] a line"
            )
        )
    return Parsed(tuple(programs), tuple(diagnostics))


def parse_program(text: str, file: str = "") -> tuple[Program, tuple[Diagnostic, ...]]:
    """Read a text that should hold one program; a second one is a fault."""
    parsed = _parse(text, file, several=False)
    if not parsed.programs:
        return Program(), parsed.diagnostics
    faults = list(parsed.diagnostics)
    if len(parsed.programs) > 1:
        extra = parsed.programs[1]
        line = max(1, extra.line(0) - 2)
        message = f"a second program, `{extra.title}`, in a text that should hold one"
        faults.append(Diagnostic(Code.SYNTAX, message, file, line, suggestion="move it to a file of its own"))
    return parsed.programs[0], tuple(faults)


def parse_steps(line: str) -> tuple[Step, ...] | Diagnostic:
    """Read the instructions of one line (one tick); the diagnostic's line number is left 0."""
    if len(line) > MAX_LINE:
        message = f"a line of {len(line):,} characters"
        return Diagnostic(Code.LINE_TOO_LONG, message, column=1, suggestion=f"at most {MAX_LINE:,}")
    return _parse_line(line)


def print_program(program: Program) -> str:
    """Canonical text: title, description, two blank lines, one tick a line."""
    title = program.title or ("Untitled" if program.description else "")
    head = f"{title}\n{program.description}\n\n\n" if title else ""
    return head + "".join(f"{line}\n" for line in print_lines(program))


def print_lines(program: Program) -> Iterator[str]:
    """Yield the steps as text, one tick a line."""
    several = program.agents() > 1
    for tick in program.ticks():
        yield " | ".join(print_step(step, show_agent=several) for step in tick)


def print_step(step: Step, show_agent: bool = False) -> str:
    """One instruction as text."""
    parts = [f"<char{step.agent}>"] if show_agent or step.agent else []
    parts.append(f"[{step.action}]")
    parts.extend(map(print_object, step.objects))
    if step.modifiers:
        parts.append("{" + " ".join(f"{name}={value}" for name, value in step.modifiers) + "}")
    return " ".join(parts)


def print_object(ref: ObjectRef) -> str:
    """`<cup> (1)`, or `<cup> (1.41)` when bound."""
    node = "" if ref.node is None else f".{ref.node}"
    return f"<{ref.name}> ({ref.instance}{node})"


def normal_name(name: str) -> str:
    """Lower case, words joined by single underscores."""
    return "_".join(name.replace("_", " ").lower().split())


@dataclass(slots=True)
class _Block:
    header: list[tuple[int, str]]
    steps: list[tuple[int, str]]


def _blocks(text: str, several: bool) -> Iterator[_Block]:
    """Split a text into programs; where only one is meant, blank lines inside its header part nothing."""
    block = _Block([], [])
    splitter = Splitter()
    after_blank = False
    for number, raw in enumerate(text.split("\n"), 1):
        line = raw.strip()
        if not line:
            after_blank = True
            if several or block.steps:
                splitter.blank()
            continue
        is_step = len(line) > MAX_LINE or STEP.match(line) is not None
        if splitter.begins(line, is_step) and (block.header or block.steps):
            yield block
            block = _Block([], [])
        if is_step or (block.steps and not after_blank):
            block.steps.append((number, raw))
        else:
            block.header.append((number, raw))
        after_blank = False
    if block.header or block.steps:
        yield block


def _parse_block(block: _Block, file: str) -> tuple[Program, list[Diagnostic]]:
    steps: list[Step] = []
    lines: list[int] = []
    faults: list[Diagnostic] = []
    for number, line in block.steps:
        found = parse_steps(line)
        if isinstance(found, Diagnostic):
            faults.append(_placed(found, file, number, line))
        else:
            steps.extend(found)
            lines.extend([number] * len(found))
    first, raw = block.header[0] if block.header else (0, "")
    title = raw.strip()
    if not block.steps:
        suggestion = "write steps such as `[Walk] <kitchen> (1)` below the description"
        message = f"`{title[:60]}` has no steps"
        shown = title[:200]
        fault = Diagnostic(Code.EMPTY, message, "", 0, raw.find(title) + 1, len(shown), shown, suggestion)
        faults.append(_placed(fault, file, first, raw))
    description = "\n".join(line.strip() for _, line in block.header[1:])
    return Program(title, description, tuple(steps), tuple(lines)), faults


def _placed(fault: Diagnostic, file: str, number: int, line: str) -> Diagnostic:
    source, before = excerpt(line.rstrip("\n"), fault.column)
    return replace(fault, file=file, line=number, source=source, before=before)


@lru_cache(maxsize=65_536)
def _parse_line(line: str) -> tuple[Step, ...] | Diagnostic:
    steps: list[Step] = []
    position = 0
    while True:
        match = _STEP.match(line, position)
        if match is None or (match.end() < len(line) and line[match.end()] != "|"):
            bare = _REMARK.sub("", line, count=1)
            return _parse_line(bare) if bare != line else explain(line, position)
        step = _step(match, joins=bool(steps))
        if isinstance(step, Diagnostic):
            return step
        steps.append(step)
        if match.end() == len(line):
            return tuple(steps)
        position = match.end() + 1


def _step(match: re.Match[str], joins: bool) -> Step | Diagnostic:
    agent, action, objects, braces = match[1], match[2], match[3], match[7] or ""
    if normal_name(action) == SPECIAL:
        return special(match.string)
    refs = tuple(
        ObjectRef(normal_name(name), int(instance or 1), int(node) if node else None)
        for name, instance, node in _OBJECTS.findall(objects)
    )
    pairs = tuple(_MODIFIER.findall(braces[1:-1]))
    if braces and " ".join(f"{name}={value}" for name, value in pairs) != " ".join(braces[1:-1].split()):
        column = match.start(7) + 1
        text = "modifiers are not `name=value` pairs"
        return Diagnostic(
            Code.SYNTAX, text, column=column, length=len(braces), found=braces, suggestion="{at=3,2 hand=left}"
        )
    return Step(action, refs, int(agent or 0), joins, pairs)
