"""`check`: are these programs well written?"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hearth.commands import output
from hearth.schemas.errors import Diagnostic
from hearth.schemas.failures import Code
from hearth.schemas.syntax import parse_programs
from hearth.schemas.text import decode

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge

Files = Annotated[list[Path], typer.Argument(metavar="FILE", help="Program files; `-` reads standard input.")]
Kb = Annotated[Path | None, typer.Option("--kb", metavar="DIR", help="A folder of knowledge laid over ours.")]
Affordances = Annotated[
    bool, typer.Option("--affordances", help="Report objects that an action is never done to, as well.")
]


@dataclass(frozen=True, slots=True)
class Checked:
    """What was found in one file."""

    file: str
    programs: int
    steps: int
    faults: tuple[Diagnostic, ...]


def check(files: Files, affordances: Affordances = False, kb: Kb = None, as_json: output.Json = False) -> None:
    """Check program files and underline what is wrong.

    Every fault of every file is reported at once: lines that are no steps, instances that are no numbers, actions and
    objects nobody knows, a wrong number of objects. A file may hold several programs. The status is 1 if there was
    any fault.

    \b
    Example:
      python cli.py check morning.txt evening.txt
    """
    from hearth.kb import knowledge

    known = knowledge.load(overlay=kb) if kb else knowledge.default()
    checked = [check_file(file, known, affordances=affordances) for file in files]
    faults = sum(len(each.faults) for each in checked)
    if as_json:
        output.emit({"files": [_json(each) for each in checked], "faults": faults})
    else:
        _print(checked, faults)
    output.status(faults, strict=True)


def check_file(path: Path, knowledge: Knowledge, *, affordances: bool = False) -> Checked:
    """Read one file and find every fault in it; a file that can't be read is a fault too."""
    name = "standard input" if path == Path("-") else str(path)
    try:
        text = decode(sys.stdin.buffer.read() if path == Path("-") else path.read_bytes(), name)
    except OSError as error:
        code = Code.UNSUPPORTED_FILE if isinstance(error, IsADirectoryError) else Code.MISSING_FILE
        text = Diagnostic(code, (error.strerror or "can't be read").lower(), name)
    if isinstance(text, Diagnostic):
        return Checked(name, 0, 0, (text,))
    return check_text(text, knowledge, name, affordances=affordances)


def check_text(text: str, knowledge: Knowledge, file: str = "", *, affordances: bool = False) -> Checked:
    """Find every fault of a text that holds programs: of syntax, names and arity, ordered by line."""
    from hearth.kb import grammar

    parsed = parse_programs(text, file)
    source = text.splitlines()
    faults = list(parsed.diagnostics)
    for program in parsed.programs:
        canonical, found = grammar.check(program, knowledge, file, source)
        faults += found
        if affordances:
            faults += grammar.affordances(canonical, knowledge, file, source)
    faults.sort(key=lambda fault: (fault.line, fault.column))
    steps = sum(len(program.steps) for program in parsed.programs)
    return Checked(file, len(parsed.programs), steps, tuple(faults))


def _json(checked: Checked) -> dict[str, Any]:
    faults = [output.diagnostic_json(fault) for fault in checked.faults]
    return {"file": checked.file, "programs": checked.programs, "steps": checked.steps, "faults": faults}


def _print(checked: list[Checked], faults: int) -> None:
    for each in checked:
        output.report(each.faults, sys.stdout)
    programs, steps = sum(each.programs for each in checked), sum(each.steps for each in checked)
    said = output.counted(faults, "fault") if faults else "no faults"
    counts = [output.counted(len(checked), "file"), output.counted(programs, "program"), output.counted(steps, "step")]
    print(f"{', '.join(counts)}: {said}")
