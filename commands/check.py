"""`check`: finds the faults of program files."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import grouped_faults, inputs, output
from hearth.commands.grouped_faults import in_order, place_of
from hearth.kb import action_grammar
from hearth.kb.language.reading_modes import Fuzzy
from hearth.kb.language.recognition_knowledge import recognizing
from hearth.pipelines.checks.text_checks import Checked, check_text, warnings_of
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.text_decoding import decode
from hearth.storage.input_files import placed, read_input

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.storage.rejects import Reject


def check(
    files: list[Path],
    affordances: bool = True,
    lint: bool = False,
    fix: bool = False,
    diff: bool = False,
    columns: str = "",
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    strict: bool = False,
    kb: Path | None = None,
    summary: bool = False,
    as_json: bool = False,
) -> None:
    """Check programs and underline the faults.

    All faults of all files are reported: lines that are not steps, instances that are not numbers, unknown actions and
    objects, a wrong number of objects, objects that do not afford the action or are given twice, plans that are not
    understood. A file may hold several programs, in any form that `build` reads. The status is 1 if there is a fault.
    Equal faults are printed once, with their other places; --summary counts faults by kind. --fix corrects program
    text. With --lint: states set twice, actions that no simulation runs, objects used without a
    walk to them, programs without an effect.

    \b
    Examples:
      hearth check morning.txt evening.txt
      hearth check --fix morning.txt
    """
    known = inputs.read_knowledge(kb)
    diffs = {file: _fix(file, known, write=fix) for file in files} if fix or diff else {}
    how: dict[str, Any] = {"affordances": affordances, "lint": lint, "fuzzy": fuzzy, "strict": strict}
    checked = [replace(check_file(file, known, columns, **how), diff=diffs.get(file, "")) for file in files]
    faults = sum(len(each.faults) for each in checked)
    if as_json:
        output.emit({"files": [_json(each) for each in checked], "faults": faults})
    else:
        _print(checked, faults, summary=summary)
    output.status(faults, strict=True)


def _fix(path: Path, knowledge: Knowledge, *, write: bool) -> str:
    """Correct one file if it is program text; the difference as a diff."""
    from hearth.pipelines.checks import fixes
    from hearth.storage import chosen_files

    if not path.is_file() or (text := _program_text(path, str(path))) is None:
        return ""
    new = fixes.fixed(text, knowledge)
    if write and new != text:
        chosen_files.write(path, new.encode())
    return fixes.difference(text, new, str(path))


def _program_text(path: Path, name: str) -> str | None:
    """Return the text of a file that is nothing but programs; None for any other form.

    Raises:
        HearthError: it can't be read.
    """
    from hearth.pipelines.readers import program_text
    from hearth.pipelines.readers.recognition_by_content import recognise

    if not path.is_file() or [entry.reader for entry in recognise(path, name)] != [program_text.NAME]:
        return None
    found = decode(read_input(path), name)
    return found if isinstance(found, str) else None


def check_file(
    path: Path,
    knowledge: Knowledge,
    columns: str = "",
    *,
    affordances: bool = False,
    lint: bool = False,
    fuzzy: Fuzzy = Fuzzy.TYPOS,
    strict: bool = False,
) -> Checked:
    """Read an input of any form and find all faults of its programs; one that can't be read is a fault too.

    With `strict`, a step that was corrected or shortened is a fault.
    """
    name = inputs.name_of(path)
    try:
        with placed(path) as place:
            text = _program_text(place, name)
            if text is not None:
                # Parsed as a whole, so that a line that is too long hides no other fault.
                return check_text(text, knowledge, name, affordances=affordances, lint=lint)
            with recognizing(knowledge):
                found = inputs.read_programs(place, knowledge, name, columns, fuzzy)
                checked = _check_programs(found, name, knowledge, affordances=affordances, lint=lint)
            return _strictly(checked) if strict else checked
    except HearthError as error:
        return Checked(name, 0, 0, tuple(fault.at(name) for fault in error.diagnostics))


def _check_programs(
    given: Iterable[inputs.Given | Reject], name: str, knowledge: Knowledge, *, affordances: bool, lint: bool
) -> Checked:
    from hearth.storage.rejects import Reject

    programs = steps = 0
    faults: list[Diagnostic] = []
    warnings: list[Diagnostic] = []
    for found in given:
        if isinstance(found, Reject):
            # A repeated program is read once by `build`, but its text has no fault.
            repeated = found.code == Code.DUPLICATE
            faults += () if repeated else found.diagnostics
            warnings += found.diagnostics if repeated and lint else ()
            continue
        programs, steps = programs + 1, steps + len(found.program.steps)
        faults += found.faults
        faults += action_grammar.affordances(found.program, knowledge, found.place) if affordances else ()
        warnings += found.warnings
        warnings += warnings_of(found.program, knowledge, found.place, []) if lint else ()
    return Checked(name, programs, steps, tuple(faults), tuple(warnings))


def _strictly(checked: Checked) -> Checked:
    """Return the findings with fuzzy matches among the faults."""
    fuzzy = tuple(each for each in checked.warnings if each.code == Code.FUZZY_MATCH)
    others = tuple(each for each in checked.warnings if each.code != Code.FUZZY_MATCH)
    return replace(checked, faults=(*checked.faults, *fuzzy), warnings=others)


def _json(checked: Checked) -> dict[str, Any]:
    found = {name: getattr(checked, name) for name in ("file", "programs", "steps")}
    faults, warnings = in_order(checked.faults), in_order(checked.warnings)
    fuzzy = sum(each.code == Code.FUZZY_MATCH for each in (*faults, *warnings))
    more = {"warnings": warnings, "diff": checked.diff}
    return {**found, "faults": faults, "fuzzy": fuzzy, **{name: value for name, value in more.items() if value}}


_KINDS = ("error", "warning")


def _in_order(checked: Checked) -> list[tuple[str, Diagnostic]]:
    """Return the faults and warnings of a source by their places, each with its kind."""
    found = [
        (kind, each) for kind, listed in zip(_KINDS, (checked.faults, checked.warnings), strict=True) for each in listed
    ]
    return sorted(found, key=lambda pair: place_of(pair[1]))


def _print(checked: list[Checked], faults: int, *, summary: bool) -> None:
    for each in checked:
        output.line(each.diff, end="")
    found = [pair for each in checked for pair in _in_order(each)]
    if summary:
        grouped_faults.summary([(kind, [fault for its, fault in found if its == kind]) for kind in _KINDS])
    else:
        grouped_faults.report_together(found, sys.stdout)
    programs, steps = sum(each.programs for each in checked), sum(each.steps for each in checked)
    result = output.counted(faults, "fault") if faults else "no faults"
    warnings = sum(len(each.warnings) for each in checked)
    result += f", {output.counted(warnings, 'warning')}" if warnings else ""
    read = "source" if any(Path(each.file).is_dir() for each in checked) else "file"
    counts = [output.counted(len(checked), read), output.counted(programs, "program"), output.counted(steps, "step")]
    output.line(f"{', '.join(counts)}: {result}")
