"""`repair`: perturbs the preconditions of a program, and shows the failures and their repairs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace
from difflib import ndiff
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import typer

from hearth.commands import output
from hearth.commands.failure_output import failure_document
from hearth.commands.inputs import read_given
from hearth.commands.shared_options import HomeOptions
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge
    from hearth.repair.augmentation import Augmented, Pair
    from hearth.repair.perturbation_strengths import Strength
    from hearth.repair.repair_loop import Attempt
    from hearth.schemas.failures import Failure
    from hearth.schemas.program import Program, Step


def repair(
    file: Path,
    place: HomeOptions = HomeOptions(),
    seed: int = 0,
    variants: int = 1,
    strength: str = "mild",
    perturb: list[str] | None = None,
    which: int = 1,
    columns: str = "",
    strict: bool = False,
    as_json: bool = False,
) -> None:
    """Perturb the preconditions of a program, and show its repairs.

    Prints the perturbations, each failure with its repair, and the repaired program. Kinds of perturbation are those of
    perturbations.yaml: open, on, plugged, free, at_reach, ... The status is 1 if a program can't be repaired.

    \b
    Example:
      hearth repair watch_tv.txt --home maple --seed 3 --perturb free --perturb on
    """
    from hearth.repair.augmentation import Options, augment

    known = place.knowledge()
    given = read_given(file, known, which, strict, columns)
    program, home = place.placed(given, known)
    found = augment(program, home, seed, program.title, Options(variants, strength=_strength(strength, perturb)))
    if isinstance(found, Failure):
        _refuse(found, program, home.name, as_json)
    if as_json:
        output.emit({"home": home.name, "seed": seed, **repairs_document(found)})
    else:
        _print(program, found, home.name, known)
    failed = sum(pair.failure is not None and pair.failure.code not in _HARMLESS for pair in found.pairs)
    output.status(failed, strict=True)


_HARMLESS = ("UNPERTURBED", "DUPLICATE")


def _refuse(failure: Failure, program: Program, home: str, as_json: bool) -> NoReturn:
    from hearth.schemas.failure_words import in_program

    text = f"This program does not run in any start of {home} that was tried: {in_program(failure, program)}"
    output.say(text, {"home": home, "failure": failure_document(failure, program)}, as_json)
    raise typer.Exit(output.BAD_INPUT)


def _strength(name: str, kinds: list[str] | None) -> Strength:
    """Return a strength by its name; with kinds of perturbation, these alone, applied wherever possible.

    Raises:
        HearthError: UNKNOWN_ID, with the known kinds or strengths.
    """
    from hearth.repair.perturbation import PERTURBATIONS, Chances
    from hearth.repair.perturbation_strengths import strength

    unknown = [kind for kind in kinds or () if kind not in PERTURBATIONS]
    if unknown:
        known = f"kinds are {', '.join(PERTURBATIONS)}"
        raise HearthError.of(Code.UNKNOWN_ID, f"unknown perturbation `{unknown[0]}`", suggestion=known)
    found = strength(name)
    return replace(found, chances=Chances(dict.fromkeys(kinds, 1.0), {"each": 1.0})) if kinds else found


def _print(program: Program, found: Augmented, home: str, known: Knowledge) -> None:
    output.line(f"{program.title or 'A program'}, in {home}")
    output.line(f"  goal: {'; '.join(map(str, found.goal)) or 'nothing'}")
    if not found.pairs:
        output.line("  It has no precondition that can be perturbed.")
    for pair in found.pairs:
        _print_pair(pair, known)


def _print_pair(pair: Pair, known: Knowledge) -> None:
    from hearth.schemas.failure_words import in_program

    for perturbation in pair.perturbations:
        output.line(f"\nPerturbed: {perturbation}")
    for attempt in pair.attempts:
        _print_attempt(attempt, known)
    if pair.failure is not None:
        said = in_program(pair.failure, pair.program)
        output.line(f"\nGiven up: {said}" if pair.attempts else f"\n{said}")
        return
    output.line(f"\nRepaired: {output.counted(len(pair.program.steps), 'step')}.")
    before, after = _texts(pair.environment.program.steps), _texts(pair.program.steps)
    output.line("\n".join(f"  {line}" for line in _difference(before, after, every=True)))


def _print_attempt(attempt: Attempt, known: Knowledge) -> None:
    from hearth.schemas.failure_words import sentence

    row, step = known.repairs.get(attempt.handler), attempt.before[attempt.step : attempt.step + 1]
    said = sentence(attempt.failure, _number(attempt), "".join(_texts(step)), None)
    output.line(f"\n{attempt.number + 1:3}  {said}")
    output.line(f"     {attempt.handler}{': ' + row.say if row is not None and row.say else ''}")
    for line in _difference(_texts(attempt.before), _texts(attempt.after or attempt.before)):
        output.line(f"       {line}")


def _texts(steps: Iterable[Step]) -> list[str]:
    from hearth.schemas.syntax import print_step

    return [print_step(step) for step in steps]


def _difference(before: list[str], after: list[str], *, every: bool = False) -> Iterator[str]:
    """Yield inserted (`+`) and removed (`-`) lines, and with `every` also the others."""
    for line in ndiff(before, after):
        if line[0] in "+-" or (every and line[0] == " "):
            yield line


def repairs_document(found: Augmented) -> dict[str, Any]:
    """Return the perturbations of a program and its repairs, for machines."""
    return {"goal": [str(fact) for fact in found.goal], "pairs": [_pair_json(pair) for pair in found.pairs]}


def _pair_json(pair: Pair) -> dict[str, Any]:
    return {
        "perturbations": [
            {"kind": one.kind, "dropped": [*map(str, one.dropped)], "added": [*map(str, one.added)]}
            for one in pair.perturbations
        ],
        "original": _texts(pair.environment.program.steps),
        "attempts": [_attempt_json(attempt) for attempt in pair.attempts],
        "repaired": _texts(pair.program.steps) if pair.failure is None else None,
        "failure": failure_document(pair.failure, pair.program),
    }


def _number(attempt: Attempt) -> int:
    """Return the number of the step that failed, from 1; 0 where the program ran, and missed its goal."""
    return attempt.step + 1 if attempt.step < len(attempt.before) else 0


def _attempt_json(attempt: Attempt) -> dict[str, Any]:
    return {
        "attempt": attempt.number + 1,
        "step": _number(attempt) or None,
        "failure": failure_document(attempt.failure, None, _number(attempt)),
        "handler": attempt.handler,
        "before": _texts(attempt.before),
        "after": _texts(attempt.after),
    }
