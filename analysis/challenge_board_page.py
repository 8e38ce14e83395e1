"""The board of a challenge as a page that opens from disk; every text is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from hearth.analysis.challenge_board import MOST_FAULTS
from hearth.storage.templates import rendered

TITLE = "Board"


def board_page(rows: Sequence[Mapping[str, Any]], compared: Iterable[Mapping[str, Any]]) -> str:
    """Return the page.

    Args:
        rows: of `challenge_board.submissions`.
        compared: of `challenge_board.comparisons`.
    """
    shown = [_row(row) for row in rows]
    differences = [_difference(row) for row in compared]
    return rendered("hearth.analysis", "challenge_board.html", title=TITLE, rows=shown, compared=differences)


def _row(row: Mapping[str, Any]) -> dict[str, Any]:
    helper = "" if row["helper"] == "none" else f", helped by {row['helper']}"
    prints = (row["protocol_fingerprint"], row["prompt_fingerprint"])
    return {
        **{
            name: row[name]
            for name in ("file", "digest", "suite", "tasks_digest", "episodes", "unfinished", "verified")
        },
        "agent": f"{row['main']}{helper}",
        "success": _interval(row["success"], row["success_from"], row["success_to"]),
        "length": _with_half(row["length"], row["length_ci"], 1),
        "speedup": _with_half(row["speedup"], row["speedup_se"], 2),
        "tokens": "" if row["tokens_in"] is None else f"{row['tokens_in']:,}, {row['tokens_out']:,}",
        "cost": "" if row["cost"] is None else f"{row['cost']:.4f}",
        "faults": _counts(row["faults"], row["turns"]),
        "hazards": _counts(row["hazards"], None),
        "protocol": ", ".join(filter(None, (row["protocol"], row["prompt"]))),
        "fingerprints": " ".join(filter(None, prints)),
        "difference": row["differences"][0][:200] if row["differences"] else "",
    }


def _interval(value: float | None, low: float | None, high: float | None) -> str:
    return "" if value is None or low is None or high is None else f"{value:.2f} ({low:.2f} to {high:.2f})"


def _with_half(value: float | None, half: float | None, digits: int) -> str:
    if value is None:
        return ""
    return f"{value:.{digits}f}" + ("" if half is None else f" ± {half:.{digits}f}")


def _counts(counts: Mapping[str, int] | None, total: int | None) -> str:
    """Return counts by name, the most frequent first; nothing where they were not counted."""
    if counts is None:
        return ""
    some = list(counts.items())[:MOST_FAULTS]
    more = sum(counts.values()) - sum(number for _, number in some)
    said = ", ".join(f"{name} {number}" for name, number in some) + (f", others {more}" if more else "")
    return (said or "none") + ("" if total is None else f"; {total:,} answers")


def _difference(row: Mapping[str, Any]) -> dict[str, Any]:
    p = "" if row["p"] is None else f"{row['p']:.3f}"
    return {**row, "difference": _interval(row["difference"], row["from"], row["to"]), "p": p}
