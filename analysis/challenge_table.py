"""All methods of the thesis's figures 6-5 and 7-3 on the same tasks, with the thesis's text about them."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any
from xml.sax.saxutils import escape

from hearth.agents.agent_registry import HELPERS
from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges.episode_agents import NOBODY, Lineup
from hearth.challenges.episodes import Known
from hearth.challenges.metrics import CONFIDENT, mean, of_tasks, paired, speedups, summary
from hearth.challenges.result_files import Results
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite
from hearth.schemas.yaml_limits import packaged
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen

TABLES: dict[str, dict[str, Any]] = packaged("hearth.analysis", "challenge_table.yaml")["tables"]
"""By challenge: the split, the number of the thesis's figure, the main agent, and the methods."""


@dataclass(frozen=True)
class Method:
    """A row of the table.

    Attributes:
        name: as in the thesis.
        helper: of the registry.
        thesis: the thesis's text about it.
        results: the results; None where there is no such helper yet.
    """

    name: str
    helper: str
    thesis: str
    results: Results | None


def methods(
    suite: Suite,
    seeds: int,
    folder: Path,
    known: Known,
    workers: int = 1,
    watch: Callable[[str], Seen] | None = None,
    table: str = "",
) -> Iterator[Method]:
    """Run every method; results that a folder has already are kept, and who is alone is run once.

    Args:
        suite: the tasks.
        seeds: episodes of each task.
        folder: gets a file of results for each method.
        known: gives the knowledge.
        workers: processes.
        watch: for the name of a method, the function that is called with the number of its episodes done.
        table: whose methods; the challenge's own where empty.
    """
    folder.mkdir(parents=True, exist_ok=True)
    alone: Results | None = None
    given = TABLES[table or suite.challenge]
    main = given.get("main", Lineup.main)
    for row in given["methods"]:
        helper, found = row["helper"], None
        if helper in (NOBODY, *HELPERS, *ONLINE) and _ready(helper):
            seen = watch(row["name"]) if watch else unseen
            goal = row.get("goal", "")
            out = inside(folder, f"{helper}{goal and '-'}{goal}.jsonl")
            found = run(suite, Lineup(main, helper, goal), seeds, out, known, workers, seen, alone)
            alone = alone or found
        yield Method(row["name"], helper, row.get("thesis", ""), found)


def _ready(helper: str) -> bool:
    """Return whether the libraries and the network are there that a helper needs."""
    from hearth.models.model_registry import trained_names

    network = ONLINE[helper].network if helper in ONLINE else ""
    return not network or (network in trained_names() and all(map(find_spec, ("torch", "safetensors"))))


def by_set(results: Results) -> dict[str, dict[str, float]]:
    """Return the speedup for each goal set, with half the width of its 95 % interval (figures 7-6a, C-3)."""
    sets = {task.id: task.sets[0] for task in results.header.suite.tasks}
    found = speedups(results.outcomes(False), results.outcomes(results.header.helped[-1]))
    shown = {}
    for name in dict.fromkeys(sets.values()):
        one = mean([value for task, value in found.items() if sets[task] == name])
        shown[name] = {"speedup": one.value, "speedup_ci": CONFIDENT * (one.error or 0.0)}
    return shown


def rows(found: Sequence[Method]) -> list[dict[str, Any]]:
    """Return the table.

    Means over tasks with half the width of their 95 % intervals, and paired tests against the first.
    """
    table = []
    for method in found:
        row: dict[str, Any] = {"method": method.name}
        if method.results is not None:
            row |= _figures(method.results)
        table.append({**row, "thesis": method.thesis})
    return table


SHOWN = ("success", "speedup", "saving", "reward", "length", "conflict_episodes", "needless_episodes")


def _figures(results: Results) -> dict[str, Any]:
    alone, helped = results.outcomes(False), results.outcomes(True)
    found = summary(alone, helped)
    row: dict[str, Any] = {"episodes": found["episodes"]}
    for name in SHOWN:
        row[name] = found[name]
        row[f"{name}_ci"] = CONFIDENT * (found[f"{name}_se"] or 0.0)
    test = paired(of_tasks(helped or alone, "length"), of_tasks(alone, "length"))
    tested = {"t": test.t, "p": test.p, "freedom": test.freedom, "effect": test.effect}
    return {**row, **tested, "by_set": by_set(results)}


def figure(found: Sequence[dict[str, Any]]) -> str:
    """Figure 6-5, or 7-3, as SVG: a) success against speedup with 95 % intervals; b) cumulative reward."""
    there = [row for row in found if "speedup" in row]
    low, high = min(0.0, *(row["speedup"] for row in there)) - 0.2, max(row["speedup"] for row in there) + 0.3
    left = min(0.6, *(row["success"] for row in there)) - 0.05
    lines = ['<text x="20" y="20" font-size="14">a) success rate and speedup</text>']
    lines += ['<rect x="60" y="30" width="400" height="300" fill="none" stroke="#888888"/>']

    def at(row: dict[str, Any], success: float = 0.0, speedup: float = 0.0) -> tuple[float, float]:
        share = (row["success"] + success - left) / (1.05 - left)
        return 60 + 400 * share, 330 - 300 * (row["speedup"] + speedup - low) / (high - low)

    for row in there:
        x, y = at(row)
        (x0, _), (x1, _) = at(row, -row["success_ci"]), at(row, row["success_ci"])
        (_, y0), (_, y1) = at(row, 0, -row["speedup_ci"]), at(row, 0, row["speedup_ci"])
        cross = f"M{x0:.1f} {y:.1f}H{min(x1, 460):.1f}M{x:.1f} {y0:.1f}V{y1:.1f}"
        lines.append(f'<path d="{cross}" stroke="#1b4f72" fill="none"/>')
        lines.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="#1b4f72"/>')
        lines.append(f'<text x="{x - 8:.1f}" y="{y - 6:.1f}" text-anchor="end">{escape(row["method"])}</text>')
    lines += [f'<text x="54" y="{330 - 300 * k / 4:.0f}" text-anchor="end">{low + (high - low) * k / 4:.2f}</text>'
              for k in range(5)]  # fmt: skip
    lines += [f'<text x="{60 + 100 * k}" y="345" text-anchor="middle">{left + (1.05 - left) * k / 4:.2f}</text>'
              for k in range(5)]  # fmt: skip
    lines.append('<text x="500" y="20" font-size="14">b) cumulative reward</text>')
    for number, row in enumerate(there):
        y, wide = 40 + 28 * number, 180 * max(0.0, row["reward"])
        lines.append(f'<text x="625" y="{y + 13}" text-anchor="end">{escape(row["method"])}</text>')
        lines.append(f'<rect x="632" y="{y}" width="{wide:.1f}" height="18" fill="#d68910"/>')
        shown = f"{row['reward']:.2f} ± {row['reward_ci']:.2f}"
        lines.append(f'<text x="{638 + wide:.1f}" y="{y + 13}">{shown}</text>')
    head = '<svg xmlns="http://www.w3.org/2000/svg" width="920" height="360" font-family="sans-serif" font-size="11">'
    return "\n".join([head, '<rect width="100%" height="100%" fill="#ffffff"/>', *lines, "</svg>", ""])
