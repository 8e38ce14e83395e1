"""The page "Cost at scale": what large datasets take on many processors, worked out from `benchmarks/results.json`."""

from __future__ import annotations

import json
from pathlib import Path

RESULTS = Path(__file__).resolve().parents[2] / "benchmarks/results.json"

WHOLE = 10_000_000
PROCESSORS = (2, 16, 64, 256)
MEASURED = 2
"""Processors of the measured runs."""

PROGRAM = "programs: processor a program"
"""The figure of RESULTS.md for a whole build, by its size."""

FIGURES = {
    "speedup": ("workers", "augment: two workers against one"),
    "partition": ("workers", "a partition of no work"),
    "memory": ("corpus", "most memory, program text, 100,000 records"),
    "growth": ("corpus", "... over that of a tenth of them"),
    "episodes": ("challenge", "episodes, alone and with a helper in turn"),
    "again": ("challenge", "the same done again by `challenge verify`"),
    "bytes": ("challenge", "bytes of an episode"),
}
"""The section and the beginning of the name of each measured figure that is used."""


def measured() -> dict[str, float]:
    """The figures by their short names.

    Raises:
        LookupError: one is not in results.json.
    """
    stored = json.loads(RESULTS.read_text("utf-8"))
    found = {}
    for short, (section, name) in FIGURES.items():
        rows = [row for row in stored.get(section, {}).get("figures", ()) if row["name"].startswith(name)]
        if not rows:
            raise LookupError(f"{section}: {name}")
        found[short] = float(rows[0]["value"])
    return found


def sizes(section: str, what: str) -> dict[int, float]:
    """A figure of whole runs by their size: `34,875 programs: largest process`; none where none was run."""
    rows = json.loads(RESULTS.read_text("utf-8")).get(section, {}).get("figures", ())
    found = {}
    for row in rows:
        size, _, rest = row["name"].partition(" ")
        if rest == what:
            found[int(size.replace(",", ""))] = float(row["value"])
    return dict(sorted(found.items()))


def program() -> tuple[int, float]:
    """The programs of the largest whole build, and the processor seconds of each.

    Raises:
        LookupError: none is in results.json.
    """
    built = sizes("scale", PROGRAM)
    if not built:
        raise LookupError(f"scale: {PROGRAM}")
    return max(built), built[max(built)] / 1000


def whole() -> list[str]:
    """Return the cost of whole runs: programs built, episodes played and repeated; nothing where none was run."""
    lines = []
    for section, what, time, each, memory in WHOLE_RUNS:
        spent, most = sizes(section, each), sizes(section, memory)
        for size, seconds in sizes(section, time).items():
            lines.append(f"| {size:,} {what} | {hours(seconds)} | {spent[size]:.1f} ms | {most[size]:,.0f} MB |")
    head = "| whole runs on two processors | time | processor time of each | largest process |"
    return [head, "|---|---:|---:|---:|", *lines, ""] if lines else []


WHOLE_RUNS = (
    (
        "scale",
        "programs built, from reading to publishing",
        "programs: build by 2 workers",
        PROGRAM,
        "programs: largest process",
    ),
    (
        "scale_checks",
        "programs verified, all their executions done again",
        "programs: verified by 2 workers",
        "programs: verified, processor a program",
        "programs: verified, largest process",
    ),
    (
        "challenge_scale",
        "episodes played",
        "episodes: played by 2 workers",
        "episodes: played, processor an episode",
        "episodes: played, largest process",
    ),
    (
        "challenge_scale",
        "episodes done again",
        "episodes: verified by 2 workers",
        "episodes: verified, processor an episode",
        "episodes: verified, largest process",
    ),
)
"""Section, what is counted, and the names of time, processor time and memory."""


def memory() -> list[str]:
    """Return the memory that publishing keeps of a program: the slope from the smallest to the largest build."""
    found = sizes("scale", "programs: publish: largest process")
    if len(found) < 2:
        return []
    (few, small), (many, large) = min(found.items()), max(found.items())
    kept = 1e6 * (large - small) / (many - few)
    return [
        "Memory of workers does not grow with the dataset. The process that publishes keeps",
        f"{kept / 1000:.1f} kB a program, {kept * WHOLE / 1e9:.0f} GB for {WHOLE:,} programs: one machine of the",
        "cluster needs that much.",
        "",
    ]


def hours(seconds: float) -> str:
    """A duration as one reads it."""
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def page() -> str:
    """The page."""
    found = measured()
    largest, each = program()
    share = min(1.0, found["speedup"] / MEASURED)
    work = {
        "augmented programs, from reading to publishing": each * WHOLE,
        "episodes of Watch-And-Help": WHOLE / found["episodes"],
        "the same episodes done again": WHOLE / found["again"],
    }
    lines = [
        "# Cost at scale",
        "",
        "What ten million programs and ten million episodes take, worked out from what was measured on one machine",
        "of two processors ([Speed](speed.md)). Nothing was run at that size.",
        "",
        "| measured | |",
        "|---|---|",
        f"| processor time of an augmented program, in a whole build of {largest:,} | {1000 * each:.2f} ms |",
        f"| episodes a second, one process | {found['episodes']:.1f} |",
        f"| episodes done again a second, one process | {found['again']:.0f} |",
        f"| two workers against one | {found['speedup']:.2f} times |",
        f"| overhead of a partition | {found['partition']:.1f} ms |",
        f"| most memory of a process, and its growth when the corpus grows tenfold | {found['memory']:.0f} MB,"
        f" {found['growth']:.2f} times |",
        f"| bytes of an episode | {found['bytes']:,.0f} |",
        "",
        f"Time is work divided by processors and by the share of {share:.0%} that a second worker keeps. Workers of a",
        "cluster share nothing but their folder, and have to read and write it through the network.",
        "",
        f"| {WHOLE:,} | processor time |" + "".join(f" {number} processors |" for number in PROCESSORS),
        "|---|---" + "|---:" * len(PROCESSORS) + "|",
    ]
    for what, seconds in work.items():
        times = "".join(f" {hours(seconds / number / share)} |" for number in PROCESSORS)
        lines.append(f"| {what} | {seconds / 3600:,.0f} h |{times}")
    lines += [
        "",
        f"The episodes are {WHOLE * found['bytes'] / 1e9:,.0f} GB of lines.",
        "",
        "```bash",
        "dask scheduler &",
        "hearth corpus synthesize 2000000 --out synthetic.jsonl",
        "hearth build synthetic.jsonl --out s3://bucket/homes --engine dask --scheduler tcp://HOST:8786 \\",
        f"  --target {WHOLE} --pictures 0 --videos 0",
        "```",
        "",
        "What one process does at the end of a build (near duplicates over all programs, the joined tables and the",
        "catalog) is counted as if all shared it: many processors gain less than the table says. Not in these numbers:",
        "pictures, and the network.",
        "",
        *whole(),
        *memory(),
        "`python benchmarks/build_scale.py`, `scale_checks.py` and `challenge_scale.py` print seconds, memory and",
        "bytes of whole runs of any size.",
    ]
    return "\n".join(lines) + "\n"
