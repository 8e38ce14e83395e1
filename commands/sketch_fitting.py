"""Fitting and cross-validating models of sketches, for `sketch`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.commands import output
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.analysis.programs_in_homes import Script
    from hearth.kb.knowledge import Knowledge
    from hearth.simulation.world.home import Home

ALONE = "none"
"""The base of a model that builds on no other."""


def fitted(
    file: Path, programs: list[Script], places: list[Home], known: Knowledge, base: str | None, fit: Path | None,
    folds: int, seed: int, *, as_json: bool
) -> None:  # fmt: skip
    """Fit a model on annotations and write it, or cross-validate it, or both; by default on top of ours."""
    from hearth.analysis import sketch_model_training as learning
    from hearth.analysis.sketch_evaluation import annotated
    from hearth.repair.sketch_model import model_of

    below = None if base == ALONE else model_of(base or "ours")
    found = learning.examples(annotated(file, file.name, programs, known), places, known, seed)
    if len({one.activity for one in found}) < max(2, folds):
        message = f"sketches of {len({one.activity for one in found})} activities"
        raise HearthError.of(Code.EMPTY, message, file=str(file), suggestion="give programs and sketches of more")
    report: dict[str, Any] = {"programs": len(found), "steps": sum(len(one.answer) for one in found)}
    if folds:
        from hearth.analysis.sketch_validation import cross_validate

        report["ways"] = cross_validate(found, below, folds, seed)
    if fit:
        _write(learning.fit(found, file.name, below, seed).to_json(), fit)
        report["file"] = fit
    output.emit(report) if as_json else _print(report, folds)


def _write(model: dict[str, Any], path: Path) -> None:
    import orjson

    from hearth.storage.chosen_files import write

    write(path, orjson.dumps(model) + b"\n")


def _print(report: dict[str, Any], folds: int) -> None:
    rows = [
        (name, *(f"{one[key]:.3f}" for key in ("precision", "recall", "f1", "lead")),
         f"{one['lead_low']:.3f} to {one['lead_high']:.3f}")
        for name, one in report.get("ways", {}).items()
    ]  # fmt: skip
    if rows:
        output.table(("way", "precision", "recall", "F1", "lead", "95% interval"), rows)
        output.line(
            f"\nCross-validated in {folds} parts of whole activities; the lead is over the majority of each action."
        )
    output.line(f"{report['programs']} programs, {report['steps']} steps.")
    if "file" in report:
        output.line(f"Fitted: {report['file']}")
