"""`report`: a dataset as static HTML."""

from pathlib import Path

from hearth.commands import output
from hearth.commands.time_limits import WITHIN


def report(
    dataset: Path,
    out: Path = Path("report_out"),
    replays: int = 16,
    workers: int = 0,
    as_json: bool = False,
    within: float = WITHIN,
) -> None:
    """Write a dataset as one folder of static HTML; open its index.html, without a network or server.

    It has the counts of records by stage, statistics with their queries, homes as floor plans, and every program with
    its steps, preconditions, repairs, graphs before and after, and pictures; some runs play in 3D.

    \b
    Example:
      hearth report data_out --out report_out
      hearth report data_out --replays 40 --out report_out
    """
    from hearth.commands.bounded_process import in_time
    from hearth.commands.progress_line import bar
    from hearth.datasets.dataset import Dataset
    from hearth.datasets.report.report_writer import write_report

    with in_time(within), bar("shares of programs") as seen:
        programs = write_report(Dataset.open(dataset), out, workers, seen, replays)
    text = f"{output.counted(programs, 'program')}; open {out / 'index.html'}"
    output.say(text, {"out": out, "programs": programs}, as_json)
