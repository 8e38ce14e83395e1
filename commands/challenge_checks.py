"""`challenge verify | solvable | board`: whether results are true, whether tasks can be done, which runs are best."""

from pathlib import Path
from typing import Any

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


def board(results: list[Path], *, workers: int = 0, as_json: bool = False) -> None:
    """Rank runs by speedup, each replayed and its metrics computed again; the status is 1 if one is false.

    \b
    Example:
      hearth challenge board hp.jsonl mine.jsonl
    """
    from hearth.challenges.metrics import summary
    from hearth.challenges.verification import read_whole
    from hearth.challenges.verification import verify as differences
    from hearth.kb.loading.load import default

    rows: list[dict[str, Any]] = []
    for path in results:
        found = read_whole(path)
        header = found.header
        figures = summary(found.finished(False), found.finished(True))
        rows.append(
            {
                "file": path.name,
                "suite": f"{header.suite.challenge} {header.suite.split}",
                "published": header.suite.published,
                "main": header.lineup.main,
                "helper": header.lineup.helper,
                "goal": header.lineup.goal,
                "episodes": figures["episodes"],
                "unfinished": len(found.unfinished),
                "success": figures["success"],
                "speedup": figures["speedup"],
                "speedup_se": figures["speedup_se"],
                "reward": figures["reward"],
                "verified": not differences(found, str(path), default, workers),
            }
        )
    rows.sort(key=lambda row: (not row["verified"], row["speedup"] is None, -(row["speedup"] or 0), row["file"]))
    if as_json:
        output.emit(rows)
    else:
        output.records(rows)
    output.status(sum(not row["verified"] for row in rows), strict=True)
