"""The syntax of programs: text to steps and back.

    <char0> [PutBack] <cup> (1.41) <table> (2) {at=3,2 hand=left} | <char1> [StandUp]

An agent is named only where there are several; an instance is `(1)` as collected or `(1.41)` once bound to node 41;
modifiers are optional; `|` parts what several agents do in one tick. Names are checked by `hearth.kb.grammar`.
Printing what was parsed gives canonical text back unchanged.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

from hearth.schemas.errors import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Program, Step

MAX_LINE = 10_000
"""Characters a line may have; a longer one is rejected instead of being searched for steps."""

SPECIAL = "special"

_OBJECT = r"<\s*([^<>\[\]]*?)\s*>\s*\(\s*(\d{1,9})(?:\.(\d{1,9}))?\s*\)"
_STEP = re.compile(
    rf"\s*(?:<\s*char(\d{{1,3}})\s*>\s*)?\[\s*([A-Za-z][A-Za-z _-]*?)\s*\]\s*((?:{_OBJECT}\s*)*)(\{{[^{{}}]*\}})?\s*",
    re.IGNORECASE,
)
_OBJECTS = re.compile(_OBJECT)
_LOOKS_LIKE_STEP = re.compile(r"^\s*(\[|<|\(|\|)")
_MODIFIER = re.compile(r"([a-z]+)=(\S+)")


@dataclass(frozen=True, slots=True)
class Parsed:
    """What a text holds: programs as far as they could be read, and every fault."""

    programs: tuple[Program, ...]
    diagnostics: tuple[Diagnostic, ...]


def parse_programs(text: str, file: str = "") -> Parsed:
    """Read every program of a text; a line that is no step becomes a diagnostic, never a silent loss."""
    programs: list[Program] = []
    diagnostics: list[Diagnostic] = []
    for block in _blocks(text):
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
    parsed = parse_programs(text, file)
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
    """The steps as text, one tick a line."""
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
    header: list[str]
    steps: list[tuple[int, str]]


def _blocks(text: str) -> Iterator[_Block]:
    """Split a text into programs: a plain line after a blank one, once steps were seen, begins the next."""
    block = _Block([], [])
    after_blank = False
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line:
            after_blank = True
            continue
        is_step = len(line) > MAX_LINE or _LOOKS_LIKE_STEP.match(line) is not None
        if is_step or (block.steps and not after_blank):
            block.steps.append((number, raw))
        else:
            if block.steps:
                yield block
                block = _Block([], [])
            block.header.append(line)
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
    title = block.header[0] if block.header else ""
    if not block.steps:
        suggestion = "write steps such as `[Walk] <kitchen> (1)` below the description"
        faults.append(Diagnostic(Code.EMPTY, f"`{title[:60]}` has no steps", file, suggestion=suggestion))
    return Program(title, "\n".join(block.header[1:]), tuple(steps), tuple(lines)), faults


def _placed(fault: Diagnostic, file: str, number: int, line: str) -> Diagnostic:
    source = line.rstrip("\n")[:200]
    return Diagnostic(
        fault.code, fault.message, file, number, fault.column, fault.length, fault.found, fault.suggestion, source
    )


@lru_cache(maxsize=65_536)
def _parse_line(line: str) -> tuple[Step, ...] | Diagnostic:
    steps: list[Step] = []
    position = 0
    while True:
        match = _STEP.match(line, position)
        if match is None or (match.end() < len(line) and line[match.end()] != "|"):
            return _explain(line, position)
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
        return _special(match.string, match.start(2))
    refs = tuple(
        ObjectRef(normal_name(name), int(instance), int(node) if node else None)
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


def _special(line: str, start: int) -> Diagnostic:
    return Diagnostic(
        Code.SPECIAL_BLOCK,
        "a special block: free text where no action fitted",
        column=start,
        length=len(line.strip()),
        found=line.strip()[:200],
        suggestion="map its text to steps in the special-blocks file, or leave it out",
    )


def _explain(line: str, position: int) -> Diagnostic:
    """Say what is wrong with a line that did not parse, pointing at the first offending words."""
    rest = line[position:]
    if re.match(r"\s*\[\s*special\s*\]", rest, re.IGNORECASE):
        return _special(line, position + 1)
    bad = re.search(r">\s*\(([^()]*)\)", rest)
    while bad and re.fullmatch(r"\s*\d{1,9}(\.\d{1,9})?\s*", bad[1]):
        bad = re.compile(r">\s*\(([^()]*)\)").search(rest, bad.end())
    if bad:
        column = position + bad.start(1) + 1
        message = f"`{bad[1][:40]}` is not an instance"
        return Diagnostic(
            Code.BAD_INSTANCE,
            message,
            "",
            0,
            column,
            len(bad[1]),
            bad[1][:200],
            "a number: (1), or (1.319) once bound to node 319",
        )
    action = re.match(r"\s*(?:<[^<>]*>\s*)?\[[^\[\]]*\]", rest)
    column = position + (action.end() if action else 0) + 1
    found = line[column - 1 :].strip()[:200]
    message = "expected an object such as `<cup> (1)`" if action else "expected an action such as `[Walk]`"
    suggestion = "[Action] <object> (1), with `|` between the agents of one tick"
    return Diagnostic(Code.SYNTAX, message, "", 0, column, len(found), found, suggestion)
