"""python benchmarks/everyday_instructions.py FILE [--model NAME] [--show N]: everyday instructions that are reached.

FILE has JSON lines of `id`, `instruction`, `wordings`, `homes` and `goal`, as `tests/models/everyday.jsonl`.
`hearth.analysis.everyday_instructions` says how they are tried. Rows without a goal ask for what no home can do: they
are to be refused. The figures: texts, the share of pairs of text and home in which the goal is reached, the share of
texts for which it is in all homes, programs that run, programs that repeat themselves, and goals that held at the
start.
"""

import argparse
from pathlib import Path

from hearth.analysis.everyday_instructions import Tried, asking, figures, homes_for, rows_of, tried
from hearth.models.model_registry import restore


def main() -> None:
    """Print the figures."""
    options = argparse.ArgumentParser(description=__doc__.split(":")[0])
    options.add_argument("file", type=Path)
    options.add_argument("--model", default="reader")
    options.add_argument("--seed", type=int, default=0, help="of the homes that are chosen")
    options.add_argument("--show", type=int, default=0, help="print at most this number that are not reached")
    given = options.parse_args()
    asked = asking(restore(given.model)[1])
    rows = rows_of(given.file)
    homes = {row.id: homes_for(row, given.seed) for row in rows}
    asked("Turn on the TV.", _warm(rows[0].homes[0]))
    said = [tried(row, row.instruction, home, asked) for row in rows for home in homes[row.id]]
    others = [tried(row, text, home, asked) for row in rows for text in row.wordings for home in homes[row.id]]
    for name, found in (("instructions", said), ("other wordings", others)):
        for kind, some in (("", [each for each in found if each.row.goal]), (
                "that no home can do", [each for each in found if not each.row.goal])):  # fmt: skip
            if some:
                print(f"{given.model}, {name} {kind}: {_refused(some) if kind else _line(some)}".replace(" :", ":"))
    missed = [
        each for each in (*said, *others) if each.runs != bool(each.row.goal) or each.reached != bool(each.row.goal)
    ]
    _show(missed, given.show)


def _warm(home: str):
    from hearth.analysis.everyday_instructions import start_without
    from hearth.schemas.goals import Goal

    return start_without(Goal(), home, "warm")


def _line(found: list[Tried]) -> str:
    one = figures(found)
    return (
        f"{one.asked} in 3 homes each; reached {one.reached:.1%} of {one.tried}, "
        f"in every home {one.reached_everywhere:.1%}; "
        f"run {one.runs:.1%}; repeat themselves {one.repeats}; held at the start {one.held}; "
        f"{one.milliseconds:.0f} ms (99 %: {one.slowest:.0f} ms)"
    )


def _refused(found: list[Tried]) -> str:
    programs = sum(each.runs for each in found)
    return f"refused {len(found) - programs} of {len(found)} ({1 - programs / len(found):.1%})"


def _show(missed: list[Tried], most: int) -> None:
    by_text: dict[str, list[Tried]] = {}
    for each in missed:
        by_text.setdefault(each.text, []).append(each)
    for text, several in list(by_text.items())[:most]:
        one = several[0]
        print(f"{one.row.id} {text} ({', '.join(each.home for each in several)}): {one.row.goal[:200]}")
        print(f"    {' '.join(one.steps) or one.note}{' | ' + one.note if one.steps and one.note else ''}")


if __name__ == "__main__":
    main()
