"""`check`: finds the faults of program files."""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hearth.commands import inputs, options, output
from hearth.schemas.decoding import decode
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.syntax import parse_programs
from hearth.storage.inputs import read_input

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.program import Program

Files = Annotated[list[Path], typer.Argument(metavar="FILE", help="Program files; `-` reads standard input.")]
Affordances = Annotated[bool, typer.Option("--affordances", help="Also report objects that do not afford an action.")]


Lint = Annotated[bool, typer.Option("--lint", help="Also warn of contradictions and missing steps.")]
Fix = Annotated[bool, typer.Option("--fix", help="Make the safe corrections in the files and show a diff.")]
DryRun = Annotated[bool, typer.Option("--diff", help="Show the diff of --fix without changing the files.")]


@dataclass(frozen=True, slots=True)
class Checked:
    """The counts, faults and warnings of one file."""

    file: str
    programs: int
    steps: int
    faults: tuple[Diagnostic, ...]
    warnings: tuple[Diagnostic, ...] = ()
    diff: str = ""


def check(
    files: Files,
    affordances: Affordances = False,
    lint: Lint = False,
    fix: Fix = False,
    diff: DryRun = False,
    kb: options.Kb = None,
    as_json: options.Json = False,
) -> None:
    """Check program files and underline the faults.

    All faults of all files are reported: lines that are not steps, instances that are not numbers, unknown actions and
    objects, a wrong number of objects. A file may hold several programs. The status is 1 if there is a fault. With
    --lint: states set twice, objects used without a walk to them, programs without an effect.

    \b
    Examples:
      python cli.py check morning.txt evening.txt
      python cli.py check --fix morning.txt
    """
    known = inputs.read_knowledge(kb)
    diffs = {file: _fix(file, known, write=fix) for file in files} if fix or diff else {}
    checked = [
        replace(check_file(file, known, affordances=affordances, lint=lint), diff=diffs.get(file, "")) for file in files
    ]
    faults = sum(len(each.faults) for each in checked)
    if as_json:
        output.emit({"files": [_json(each) for each in checked], "faults": faults})
    else:
        _print(checked, faults)
    output.status(faults, strict=True)


def _fix(path: Path, knowledge: Knowledge, *, write: bool) -> str:
    """Correct one file if it is text; the difference as a diff."""
    from hearth.pipelines.checks import fixes
    from hearth.storage.files import write_bytes

    if str(path) == "-" or not path.is_file():
        return ""
    text = decode(read_input(path), str(path))
    if isinstance(text, Diagnostic):
        return ""
    new = fixes.fixed(text, knowledge)
    if write and new != text:
        write_bytes(path, new.encode())
    return fixes.difference(text, new, str(path))


def check_file(path: Path, knowledge: Knowledge, *, affordances: bool = False, lint: bool = False) -> Checked:
    """Read one file and find all its faults; a file that can't be read is a fault too."""
    name = "standard input" if path == Path("-") else str(path)
    try:
        text = decode(read_input(path), name)
    except HearthError as error:
        return Checked(name, 0, 0, error.diagnostics)
    if isinstance(text, Diagnostic):
        return Checked(name, 0, 0, (text,))
    return check_text(text, knowledge, name, affordances=affordances, lint=lint)


def check_text(
    text: str, knowledge: Knowledge, file: str = "", *, affordances: bool = False, lint: bool = False
) -> Checked:
    """Find all faults of a text of programs: of syntax, names and arity, ordered by line."""
    from hearth.kb import grammar

    parsed = parse_programs(text, file)
    source = text.split("\n")
    faults = list(parsed.diagnostics)
    warnings: list[Diagnostic] = []
    for program in parsed.programs:
        canonical, found = grammar.check(program, knowledge, file, source)
        faults += found
        if affordances:
            faults += grammar.affordances(canonical, knowledge, file, source)
        if lint and not found:
            warnings += _warnings(canonical, knowledge, file, source)
    faults.sort(key=lambda fault: (fault.line, fault.column))
    steps = sum(len(program.steps) for program in parsed.programs)
    return Checked(file, len(parsed.programs), steps, tuple(faults), tuple(warnings))


def _warnings(program: Program, knowledge: Knowledge, file: str, source: list[str]) -> list[Diagnostic]:
    from hearth.pipelines.checks import programs

    found = [*programs.contradictions(program, knowledge), *programs.findings(program, knowledge)]
    return [programs.diagnostic(each, program, file, source) for each in found]


def _json(checked: Checked) -> dict[str, Any]:
    found = {name: getattr(checked, name) for name in ("file", "programs", "steps", "faults")}
    return found | {name: value for name in ("warnings", "diff") if (value := getattr(checked, name))}


def _print(checked: list[Checked], faults: int) -> None:
    for each in checked:
        sys.stdout.write(each.diff)
        output.report(each.faults, sys.stdout)
        output.report(each.warnings, sys.stdout, kind="warning")
    programs, steps = sum(each.programs for each in checked), sum(each.steps for each in checked)
    result = output.counted(faults, "fault") if faults else "no faults"
    warnings = sum(len(each.warnings) for each in checked)
    result += f", {output.counted(warnings, 'warning')}" if warnings else ""
    counts = [output.counted(len(checked), "file"), output.counted(programs, "program"), output.counted(steps, "step")]
    print(f"{', '.join(counts)}: {result}")
