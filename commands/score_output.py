"""Output of `score`: a table or JSON of means and first failures, the parts left out, and the refused rows."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.scoring.evaluate import Options, Summary
    from hearth.scoring.prediction_scores import Scored
    from hearth.scoring.refused_rows import FirstFaults


def show(scored: Sequence[Scored], how: Options, by: str | None, rejects: FirstFaults, as_json: bool) -> None:
    """Print the means of all scores, by a field if a field is named, or everything as JSON."""
    from hearth.scoring.evaluate import by_field, summarise

    summary, groups = summarise(scored, how.seed), by_field(scored, by, how.seed) if by else {}
    if as_json:
        output.emit(_program_json(scored, how, summary, {"by": groups} if by else {}, rejects))
    else:
        _print_program(_signatures(scored, how), summary, by, groups, rejects)


def _signatures(scored: Sequence[Scored], how: Options) -> dict[str, str]:
    from hearth.scoring.evaluate import given_goal, signatures

    return signatures(how, sum(given_goal(each.pair) is not None and not each.goal_faults for each in scored))


def _program_json(
    scored: Sequence[Scored],
    how: Options,
    summary: Summary,
    groups: dict[str, dict[str, Summary]],
    rejects: FirstFaults,
) -> dict[str, Any]:
    from hearth.scoring.prediction_scores import METRICS

    rows = [
        {
            "id": each.pair.id,
            **{name: each.pair.more[name] for name in ("home", "title") if name in each.pair.more},
            **{name: value for name, metric in METRICS.items() if (value := metric(each)) is not None},
            "missing": each.missing,
            "empty": each.empty,
            "fuzzy": each.pair.fuzzy,
            "error": each.execution and each.execution.error,
            "code": each.execution and each.execution.code,
            "goal_fault": each.goal_faults[0].code if each.goal_faults else None,
            "failed_line": each.execution and each.execution.failed_line,
        }
        for each in scored
    ]
    parts = {key: {name: _summary_json(group) for name, group in found.items()} for key, found in groups.items()}
    signed = {"signatures": _signatures(scored, how)}
    return {**signed, **_summary_json(summary), **rejects_json(rejects), **parts, "scores": rows}


def _summary_json(summary: Summary) -> dict[str, Any]:
    counts = {name: getattr(summary, name) for name in COUNTS}
    found = {"mean": summary.means, "errors": summary.errors, "codes": summary.codes, "failed_at": summary.failed_at}
    return counts | found


COUNTS = (
    "count",
    "missing",
    "empty",
    "unreferenced",
    "fuzzy",
    "unread_goals",
    "reached_before",
    "incomparable",
    "inexact",
)
"""Counts of a summary."""


def rejects_json(rejects: FirstFaults) -> dict[str, Any]:
    """Return the number of refused rows and their different faults; nothing without any."""
    return {"rejected": rejects.rows, "rejects": list(rejects)} if rejects else {}


def end(rejects: FirstFaults) -> None:
    """Report the rows and goals that were refused, and end with status 1 if there are any."""
    output.report(rejects)
    output.status(rejects.rows + rejects.notes, strict=True)


def warn_missing(scored: Sequence[Scored]) -> None:
    """Warn where most references have no prediction, and say how to leave them out."""
    missing = sum(each.missing for each in scored)
    if 2 * missing > len(scored):
        output.note(
            f"Warning: {missing:,} of {output.counted(len(scored), 'reference')} have no prediction and count as 0. "
            "--only-given scores those that have one; --originals asks for original programs alone."
        )


def _print_program(
    signed: dict[str, str], summary: Summary, by: str | None, groups: dict[str, Summary], rejects: FirstFaults
) -> None:
    output.table(["score", "mean", "95% from", "to"], [[name, *found] for name, found in summary.means.items()])
    if by:
        output.line()
        columns = list(summary.means)
        rows = [[name, group.count, *_means(group, columns)] for name, group in groups.items()]
        output.table([by, "rows", *columns], rows)
    if summary.errors:
        output.line()
        output.table(["first failure", "programs"], summary.errors.items())
        output.line()
        output.table(["code", "programs"], summary.codes.items())
    output.line(f"\n{_sentence(summary)}{_refused(rejects)}")
    shown = tuple(summary.means)
    output.line("\n".join(text for name, text in signed.items() if any(each.startswith(name) for each in shown)))


def _means(group: Summary, columns: Sequence[str]) -> list[float | None]:
    return [group.means[name].mean if name in group.means else None for name in columns]


def _refused(rejects: FirstFaults) -> str:
    return f"; {output.counted(rejects.rows, 'row')} refused" if rejects.rows else ""


def _sentence(summary: Summary) -> str:
    with_one = output.counted(summary.count - summary.unreferenced, "reference")
    parts = [with_one] if summary.count > summary.unreferenced else []
    if summary.unreferenced:
        parts.append(f"{output.counted(summary.unreferenced, 'prediction')} without a reference")
    parts.append(f"predictions: {summary.missing} missing, {summary.empty} empty")
    if summary.fuzzy:
        parts.append(
            f"{output.counted(summary.fuzzy, 'step')} with words corrected or left out (--fuzzy off refuses them)"
        )
    if summary.unread_goals:
        parts.append(f"{output.counted(summary.unread_goals, 'goal')} that can't be read, left out of `goal`")
    if summary.reached_before:
        parts.append(f"{summary.reached_before} left out of `goal`, because nothing of it was left to do at the start")
    if summary.incomparable:
        parts.append(f"{summary.incomparable} without F1 and goal, because the reference does not run")
    if summary.inexact:
        why = "because there are too many assignments of instances"
        parts.append(f"the F1 of {summary.inexact} is a lower bound, {why}")
    return "; ".join(parts)
