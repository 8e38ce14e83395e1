"""Two checkouts measured by turns, so that a machine that slows down slows both: is any row of the new one worse?

    python benchmarks/checkout_comparison.py OLD NEW [--times 5] [--only kb --only homes] [--quick]
        [--dataset DIR] [--json FILE]

OLD and NEW are folders of checkouts with a `.venv` each. Each `*_speed.py` that both have is run by the checkout's own
python in its own folder: old, new, old, new. A row's figure is its `undisturbed` one, else its ratio to the plain
reference, else what was measured (memory, shares). It is worse (and the status 1) where the median of its runs has
changed for the worse by more than a tenth plus its spread, the greater of the two checkouts'. Set HEARTH_REAL_DATA, so
that both find the release's sample. `publish` measures the same dataset of both, `--dataset`, and is left out without
one. `--quick` leaves out the memory that readers take (of `corpus`), and `render` and `workers`.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

from measurement import spread, stalls

TOLERANCE = 0.1
"""By what part a row may be worse, besides its spread."""

Key = tuple[str, str]
"""A benchmark, and the name of its row."""

LONG = ("render", "workers")
"""Benchmarks that `--quick` leaves out."""

LESS = re.compile(r"^(s|ms|us|MB|MiB)$")
"""Units of which less is better; of rates and shares more is."""

VARYING = re.compile(r" \(\d[\d.,]* MB\)")
"""A part of a row's name that changes from run to run."""


class Compared(NamedTuple):
    """A row of both checkouts: medians of the same figure."""

    key: Key
    figure: str
    old: float
    new: float
    change: float
    """By what part of the old; less than 0 where it is worse."""
    spread: float

    @property
    def verdict(self) -> str:
        """`worse` beyond tolerance and spread."""
        return "worse" if -self.change > TOLERANCE + self.spread else "ok"


def figures(rows: Iterable[Mapping[str, Any]]) -> dict[str, tuple[str, float, bool]]:
    """Of each row of one run, by a name that the next run has, too: which figure, its value, whether less is better."""
    seen: Counter[str] = Counter()
    found = {}
    for row in rows:
        if row["unit"] == "% of the time":
            continue  # of the machine
        name = VARYING.sub("", row["name"])
        seen[name] += 1
        known = name if seen[name] == 1 else f"{name} [{seen[name]}]"
        less = bool(LESS.match(row["unit"])) or name.startswith("... over")
        kind = next((kind for kind in ("undisturbed", "ratio") if row.get(kind) is not None), "value")
        found[known] = (kind, float(row[kind]), less and kind != "ratio")
    return found


def compare(old: Sequence[Mapping[Key, Any]], new: Sequence[Mapping[Key, Any]]) -> list[Compared]:
    """Every row that all runs have."""
    found = []
    for key, (kind, _, less) in old[0].items():
        if not all(key in run for run in (*old, *new)):
            continue
        before, after = ([run[key][1] for run in runs] for runs in (old, new))
        one, other = median(before), median(after)
        change = (one - other if less else other - one) / one if one else 0.0
        found.append(Compared(key, kind, one, other, change, max(spread(before), spread(after))))
    return found


def measured(checkout: Path, name: str, options: Sequence[str]) -> dict[Key, Any]:
    """One benchmark of a checkout, run once.

    Raises:
        SystemExit: it failed.
    """
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "figures.json")
        command = [str(checkout / ".venv/bin/python"), f"benchmarks/{name}_speed.py", "--json", str(file), *options]
        environ = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
        done = subprocess.run(command, cwd=checkout, env=environ, capture_output=True, text=True, check=False)
        if done.returncode or not file.exists():
            raise SystemExit(f"{checkout}: {name}_speed.py failed with status {done.returncode}\n{done.stderr}")
        return {(name, row): value for row, value in figures(json.loads(file.read_text("utf-8"))).items()}


def table(rows: Sequence[Compared]) -> str:
    """For people, as Markdown."""
    lines = ["| row | figure | old | new | change | spread | verdict |", "|---|---|---:|---:|---:|---:|---|"]
    for row in rows:
        numbers = f"{row.old:,.4g} | {row.new:,.4g} | {row.change:+.1%} | {row.spread:.0%}"
        lines.append(f"| {': '.join(row.key)} | {row.figure} | {numbers} | {row.verdict} |")
    return "\n".join(lines)


def wanted(asked: argparse.Namespace) -> dict[str, list[str]]:
    """The benchmarks that both checkouts have, and what each is called with."""
    both = [{path.stem.removesuffix("_speed") for path in (folder / "benchmarks").glob("*_speed.py")}
            for folder in (asked.old, asked.new)]  # fmt: skip
    names = asked.only or sorted(both[0] & both[1])
    options: dict[str, list[str]] = {name: [] for name in names if not (asked.quick and name in LONG)}
    if asked.quick and "corpus" in options:
        options["corpus"] = ["--memory", "0"]
    if asked.dataset and "publish" in options:
        options["publish"] = [str(asked.dataset.resolve())]
    elif "publish" in options:
        del options["publish"]
        print("publish is left out: it needs --dataset", file=sys.stderr)
    return options


def _plain(runs: Mapping[Key, Sequence[Mapping[Key, Any]]]) -> list[dict[str, Any]]:
    return [
        {"benchmark": name, "side": side, "runs": [{row: value for (_, row), value in run.items()} for run in taken]}
        for (name, side), taken in runs.items()
    ]


def main(words: Sequence[str] | None = None) -> int:
    """Measure by turns, print the table; 1 if a row is worse."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--times", type=int, default=5, metavar="N", help="runs of each benchmark and checkout")
    parser.add_argument("--only", metavar="NAME", action="append", help="this benchmark only; may be given again")
    parser.add_argument("--quick", action="store_true", help="without the longest")
    parser.add_argument("--dataset", type=Path, metavar="DIR", help="what `publish` measures")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write all runs' figures here, too, as they come")
    asked = parser.parse_args(words)
    asked.old, asked.new = asked.old.resolve(), asked.new.resolve()
    everything: list[Compared] = []
    runs: dict[Key, list[dict[Key, Any]]] = defaultdict(list)
    for name, options in wanted(asked).items():
        for turn in range(asked.times):
            for side in ("old", "new"):
                still = stalls(1.0).value
                runs[name, side].append(measured(getattr(asked, side), name, options))
                where = f"{name} {turn + 1}/{asked.times} {side}"
                print(f"{where}, machine stands still {still:.0f}%", file=sys.stderr, flush=True)
        everything += compare(runs[name, "old"], runs[name, "new"])
        if asked.json:
            asked.json.write_text(json.dumps(_plain(runs), indent=1) + "\n", encoding="utf-8")
    print(table(everything))
    return any(row.verdict == "worse" for row in everything)


if __name__ == "__main__":
    sys.exit(main())
