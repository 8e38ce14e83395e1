"""`challenge verify | solvable | board`: whether results are true, whether tasks can be done, which runs are best."""

from pathlib import Path

from hearth.commands import challenge_household, output


def verify(results: Path, *, agents: bool = False, workers: int = 0, as_json: bool = False) -> None:
    """Do all episodes of a run again, and compute every metric again; the status is 1 if anything differs.

    \b
    Example:
      hearth challenge verify hp.jsonl
    """
    from hearth.challenges.result_files import read
    from hearth.challenges.verification import verify as differences
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    found = read(results)
    with bar("episodes") as seen:
        faults = differences(found, str(results), default, workers, agents, seen)
    if as_json:
        header = found.header
        shown = {"episodes": len(found.records), "published": header.suite.published, "suite": header.suite.digest}
        output.emit({**shown, "differences": [fault.message for fault in faults]})
    else:
        output.report(faults)
        which = "the published tasks" if found.header.suite.published else "other tasks than the published ones"
        output.line(f"{len(found.records):,} episodes of {which} replayed: {len(faults)} differ")
    output.status(len(faults), strict=True)


def solvable(
    name: str, split: list[str] | None = None, *, limit: int | None = None, workers: int = 0, as_json: bool = False
) -> None:
    """Let an agent that sees everything do each published task alone.

    The status is 1 if a task can't be done, or is done already. Tasks of `household` are drawn so that such an agent
    does each; for them the share is printed that the human-like agent does, which sees only the room it is in.

    \b
    Examples:
      hearth challenge solvable wah
      hearth challenge solvable owah --split test
      hearth challenge solvable household --limit 10
    """
    if name == challenge_household.HOUSEHOLD:
        challenge_household.print_solved(split, limit, workers, as_json)
        return
    from hearth.challenges.challenge_definition import challenge
    from hearth.challenges.published_tasks import tasks
    from hearth.challenges.solvability import solved
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default

    splits = split or list(challenge(name).splits)
    chosen = [task for each in splits for task in tasks(name, each, limit=limit)]
    with bar("tasks") as seen:
        found = list(solved(chosen, default, workers, seen))
    faults = [each.fault for each in found if each.fault]
    figures = {
        "challenge": name,
        "splits": ", ".join(splits),
        "tasks": len(found),
        "solved": len(found) - len(faults),
        "mean_ticks": round(sum(each.ticks for each in found) / len(found), 2),
        "most_ticks": max(each.ticks for each in found),
    }
    if as_json:
        output.emit({**figures, "faults": faults})
    else:
        output.figures(figures)
        for fault in faults:
            output.line(fault)
    output.status(len(faults), strict=True)


def board(results: list[Path], *, out: Path | None = None, workers: int = 0, as_json: bool = False) -> None:
    """Rank runs, each replayed and its metrics computed again, and compare each two on the tasks that both did.

    With --out the board is a page: success, ticks, tokens, cost, faults of answers by code, hazards, and fingerprints
    of the text protocol and the prompt. The status is 1 if a run is false.

    \b
    Examples:
      hearth challenge board hp.jsonl mine.jsonl
      hearth challenge board smollm2.jsonl constrained.jsonl --out board.html
    """
    from hearth.analysis.challenge_board import comparisons, submissions
    from hearth.analysis.challenge_board_page import board_page
    from hearth.commands.progress_line import bar
    from hearth.kb.loading.load import default
    from hearth.storage.chosen_files import write

    with bar("runs") as seen:
        found = submissions(results, default, workers, seen)
    rows, compared = [each.row for each in found], list(comparisons(found))
    if out is not None:
        out.parent.mkdir(parents=True, exist_ok=True)
        write(out, board_page(rows, compared).encode())
    if as_json:
        output.emit([{**row, "compared": [each for each in compared if each["one"] == row["file"]]} for row in rows])
    else:
        output.records([{name: row[name] for name in SHOWN} for row in rows])
        if compared:
            output.line()
            output.records(compared)
    output.status(sum(not row["verified"] for row in rows), strict=True)


SHOWN = (
    *("file", "suite", "published", "main", "helper", "goal", "episodes", "unfinished", "success", "length"),
    *("speedup", "speedup_se", "reward", "tokens_in", "tokens_out", "cost", "verified"),
)
"""The columns of the board that are printed; --json and the page have all."""
