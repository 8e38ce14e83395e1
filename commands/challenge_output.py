"""The results of a run as the terminal and machines get them: metrics, a table by goal set, and unfinished episodes."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Any

from hearth.commands import output

if TYPE_CHECKING:
    from hearth.challenges.episode_agents import Lineup
    from hearth.challenges.result_files import Results

ALONE = ("success", "hazards", "irreversible", "wasted", "length", "reward")
"""The metrics of an agent that acts alone; those of harm are there where acts have consequences."""

MOST_PRINTED = 10
"""Different reasons for not finishing that are printed."""


def print_results(results: Results, as_json: bool) -> None:
    """Print the summary of a run; one object for machines."""
    figures = _figures(results)
    if as_json:
        output.emit(figures)
        return
    output.figures(
        {name: figures[name] for name in ("challenge", "split", "main", "helper", "goal", "seeds", "episodes")}
    )
    alone = not results.header.helped[-1]
    measured = [name for name in figures if f"{name}_se" in figures and (not alone or name in ALONE)]
    output.line()
    rows = [(name.replace("_", " "), figures[name], figures[f"{name}_se"]) for name in measured]
    output.table(("metric", "mean over tasks", "standard error"), rows)
    if alone:
        output.line()
        output.records(figures["by_set"])
    _print_language(figures.get("language"))
    _print_unfinished(figures["unfinished"])


def _print_language(figures: dict[str, Any] | None) -> None:
    """Print what language models were asked and answered; nothing where there were none."""
    if figures and figures["turns"] is not None:
        output.line()
        shown = {name: value for name, value in figures.items() if value is not None and name != "faults"}
        faults = {f"fault {code}": number for code, number in figures["faults"].items()}
        output.figures({**shown, **faults})


def _figures(results: Results) -> dict[str, Any]:
    from hearth.analysis.challenge_board import language_figures
    from hearth.challenges.metrics import summary

    header, unfinished = results.header, results.unfinished
    helped = header.helped[-1]
    reasons = Counter((each.end["code"], each.end.get("message", "")) for each in unfinished if each.end)
    return {
        "challenge": header.suite.challenge,
        "split": header.suite.split,
        "suite": header.suite.digest,
        # A household task is made anew to find out, which `challenge verify` does.
        "published": None if header.suite.household else header.suite.published,
        "main": header.lineup.main,
        "helper": header.lineup.helper,
        "goal": header.lineup.goal,
        "seeds": header.seeds,
        **summary(results.finished(False), results.finished(True) if helped else {}),
        "ended_by_agents": dict(Counter(each.end["code"] for each in unfinished if each.end)),
        "unfinished": [
            {"code": code, "message": message, "episodes": n} for (code, message), n in reasons.most_common()
        ],
        **({} if helped else {"by_set": _by_set(results)}),
        **({"language": language_figures(results)} if header.language else {}),
    }


def _by_set(results: Results) -> list[dict[str, Any]]:
    """Return success, length and reward by the goal sets of the tasks; of an agent that acts alone."""
    from hearth.challenges.metrics import summary

    outcomes = results.finished(False)
    found: dict[str, list[str]] = {}
    for task in results.header.suite.tasks:
        found.setdefault(", ".join(task.sets), []).append(task.id)
    rows = []
    for name, ids in sorted(found.items()):
        figures = summary({each: outcomes[each] for each in ids if each in outcomes}, {})
        rows.append({"goals": name, "tasks": len(ids), "episodes": figures["episodes"]})
        rows[-1] |= {each: figures[each] for metric in ALONE for each in (metric, f"{metric}_se") if each in figures}
    return rows


def _print_unfinished(reasons: list[dict[str, Any]]) -> None:
    """Print why agents could not go on; their episodes are no scores."""
    for each in reasons[:MOST_PRINTED]:
        count = output.counted(each["episodes"], "episode")
        output.line(f"{count} not finished, without a score: {each['code']}: {each['message']}")
    if len(reasons) > MOST_PRINTED:
        output.line(f"and {len(reasons) - MOST_PRINTED:,} other reasons (--json has all)")


def note_requests(lineup: Lineup) -> None:
    """Print how many requests a run has sent to its language models, and where the other replies come from."""
    from hearth.challenges.language_agents import requests_sent

    if lineup.means.cache is not None:
        sent = requests_sent(lineup.names, lineup.asking, lineup.means)
        output.note(f"{output.counted(sent, 'request')} sent; all other replies were kept in {lineup.means.cache}")
