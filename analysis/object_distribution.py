"""Distribution of objects over places, in sampled environments and in a release's stored start graphs (figure B-4).

Also the diversity of one program's environments (5.5.2, figure 5-4).
"""

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from html import escape
from itertools import islice
from pathlib import Path
from typing import Any

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.grounding.environments.sampling import USUAL, Environment, Size, sample
from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.kb.knowledge import Knowledge
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.readers import release
from hearth.schemas.diagnostics import Diagnostic
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.vocabulary import ROOM_CATEGORY, STATE_ID, STATES
from hearth.storage.partitions import read_rows
from hearth.storage.rejects import Reject

Counts = dict[str, Counter[str]]
"""Class -> counts of its places; or class and state pair -> counts of its states."""

NOWHERE = "floor"
"""The place of things on and in nothing but their room."""


def observed(path: Path, knowledge: Knowledge, limit: int | None = None) -> tuple[Counts, Counts]:
    """Places and states of the programs' objects in a release's stored start graphs, by class."""
    places: Counts = defaultdict(Counter)
    states: Counts = defaultdict(Counter)
    for item in islice(release.scan(path, path.name), limit):
        value = {**item.value, "path": item.path} if isinstance(item.value, dict) else {}
        for home, name in sorted(value.get("graphs", {}).items()):
            text = release.text_of(value, value["grounded"][home]) if home in value.get("grounded", {}) else ""
            graphs = release.json_of(value, name)
            # Programs of the release that a build refuses do not count either.
            refused = isinstance(graphs, Diagnostic) or isinstance(release.graphs_of(graphs, name), Diagnostic)
            if isinstance(text, str) and not refused:
                _count_graph(graphs["init_graph"], _bound(text), knowledge, places, states)
    return dict(places), dict(states)


def _bound(text: str) -> set[int]:
    return {int(number) for number in re.findall(r"\(\d+\.(\d+)\)", text)}


def _count_graph(
    graph: Mapping[str, Any], nodes: set[int], knowledge: Knowledge, places: Counts, states: Counts
) -> None:
    by_id = {node["id"]: node for node in graph["nodes"]}
    held: dict[int, list[int]] = defaultdict(list)
    for edge in graph["edges"]:
        if edge["relation_type"] in ("ON", "INSIDE") and edge["from_id"] in nodes:
            held[edge["from_id"]].append(edge["to_id"])
    for node in sorted(nodes & by_id.keys()):
        known = by_id[node]
        if known.get("category") in (ROOM_CATEGORY, "Characters"):
            continue
        kind = _canonical(known["class_name"], knowledge)
        holders = [
            by_id[i]["class_name"] for i in held[node] if i in by_id and by_id[i].get("category") != ROOM_CATEGORY
        ]
        _count(kind, holders, known["states"], knowledge, places, states)


def _canonical(name: str, knowledge: Knowledge) -> str:
    return str(knowledge.same_class(name)[0]) if knowledge.object_class(name) else name


def _count(
    kind: str, holders: Sequence[str], found: Iterable[str], knowledge: Knowledge, places: Counts, states: Counts
) -> None:
    plain = ("floor", "wall", "ceiling", "mat")
    names = [_canonical(name, knowledge) for name in holders if name not in plain]
    places[kind][min(names) if names else NOWHERE] += 1
    for state in found:
        if state in STATE_ID:
            states[f"{kind}: {_pair(state)}"][state] += 1


def _pair(state: str) -> str:
    first = STATE_ID[state] // 2 * 2
    return f"{STATES[first]} or {STATES[first + 1]}"


def sampled(
    path: Path, homes: Homes, names: Sequence[str], seed: int = 0, limit: int | None = None, size: Size = USUAL
) -> tuple[Counts, Counts]:
    """Return the same counts for environments sampled for these programs, with the homes in turn."""
    places: Counts = defaultdict(Counter)
    states: Counts = defaultdict(Counter)
    for number, script in enumerate(_programs(path, homes.knowledge, limit)):
        drawn = sample(script.program, homes.home(names[number % len(names)]), seed, script.program_id, size=size)
        if isinstance(drawn, Failure):
            continue
        home = drawn[0].world.home
        for ref in drawn[0].program.objects():
            i = home.index.get(ref.node, -1) if ref.node is not None else -1
            if i < 0 or (home.rooms | home.characters) >> i & 1:
                continue
            held = (home.on[i] | home.inside[i]) & ~home.rooms
            holders = [home.classes[j] for j in range(len(home)) if held >> j & 1]
            found = [name for name, row in zip(STATES, home.states, strict=True) if row >> i & 1]
            _count(_canonical(home.classes[i], homes.knowledge), holders, found, homes.knowledge, places, states)
    return dict(places), dict(states)


def _programs(path: Path, knowledge: Knowledge, limit: int | None) -> Iterator[Script]:
    return (s for s in islice(scripts([str(path)], knowledge), limit) if not isinstance(s, Reject))


def distances(one: Counts, other: Counts) -> dict[str, tuple[float, int, int]]:
    """Return for each common class the total variation distance (0 to 1), and the number of observations in both."""
    found = {}
    for kind in sorted(one.keys() & other.keys()):
        a, b = one[kind], other[kind]
        apart = sum(abs(a[place] / a.total() - b[place] / b.total()) for place in a.keys() | b.keys()) / 2
        found[kind] = (round(apart, 3), a.total(), b.total())
    return found


def held(counts: Counts) -> Counts:
    """Return the counts without `NOWHERE`: the release leaves most added things in the middle of a room."""
    found = {kind: Counter({p: n for p, n in places.items() if p != NOWHERE}) for kind, places in counts.items()}
    return {kind: places for kind, places in found.items() if places}


def overall(found: Mapping[str, tuple[float, int, int]]) -> float | None:
    """Return the mean distance, weighted by the classes' frequency in the release."""
    total = sum(seen for _, seen, _ in found.values())
    return round(sum(apart * seen for apart, seen, _ in found.values()) / total, 3) if total else None


def diversity(program: Program, homes: Homes, name: str, samples: int, seed: int = 0) -> dict[str, Any]:
    """Return the number of different environments among samples of one program, and their conditions by class."""
    conditions = infer(program, homes.knowledge)
    if isinstance(conditions, Failure):
        return {"samples": 0, "distinct": 0, "impossible": conditions.message()}
    seen: set[tuple[Any, ...]] = set()
    nodes: Counter[int] = Counter()
    failed: Counter[str] = Counter()
    for number in range(samples):
        drawn = sample(program, homes.home(name), seed, f"{program.title}/{number}", conditions)
        if isinstance(drawn, Failure):
            failed[str(drawn.code)] += 1
            continue
        seen.add(_key(drawn[0]))
        nodes[len(drawn[0].world.home)] += 1
    return {
        "samples": samples,
        "distinct": len(seen),
        "failed": dict(sorted(failed.items())),
        "fewest_nodes": min(nodes, default=0),
        "most_nodes": max(nodes, default=0),
        "preconditions": bars(conditions),
    }


def _key(environment: Environment) -> tuple[Any, ...]:
    """Return a key that is equal for environments of one home with equal graphs."""
    kinds = tuple((node.id, node.class_name) for node in environment.nodes)
    home = environment.world.home
    return kinds, tuple(home.on), tuple(home.inside), tuple(home.close), home.states, tuple(home.agent_rows)


def bars(conditions: Preconditions | Iterable[Any]) -> dict[str, dict[str, int]]:
    """Conditions by class and name: the bars of figure 5-4."""
    found: dict[str, Counter[str]] = defaultdict(Counter)
    for condition in conditions:
        for kind, _ in dict.fromkeys(condition.objects):
            found[kind][condition.name] += 1
    return {kind: dict(sorted(counts.items())) for kind, counts in sorted(found.items())}


def of_programs(path: Path, knowledge: Knowledge, classes: Sequence[str], limit: int | None = None) -> Counts:
    """Counts of preconditions on some classes, over the programs of a source."""
    found: Counts = {name: Counter() for name in classes}
    for script in _programs(path, knowledge, limit):
        conditions = infer(script.program, knowledge)
        for kind, counts in ({} if isinstance(conditions, Failure) else bars(conditions)).items():
            if kind in found:
                found[kind].update(counts)
    return found


def of_cases(folder: Path, classes: Sequence[str]) -> Counts:
    """Return the same counts over a stage's cases (`sample` or `augment`), with violated conditions as perturbed."""
    found: Counts = {name: Counter() for name in classes}
    for part in sorted(folder.glob("part-*.parquet")):
        for row in read_rows(part, ["conditions"]):
            for condition in row["conditions"] or ():
                for kind in dict.fromkeys(ref["name"] for ref in condition["objects"]):
                    if kind in found:
                        found[kind][condition["name"]] += 1
    return found


def heat_map(counts: Counts, title: str) -> str:
    """Figure B-4 as SVG: rows are objects, columns places; darkness is the share of the object's observations."""
    kinds = sorted(counts)
    places = sorted({place for found in counts.values() for place in found}, key=lambda p: (p == NOWHERE, p))
    cell, left, above = 14, 150, 140
    lines = [f'<text x="8" y="16" font-size="13">{escape(title)}</text>']
    for j, place in enumerate(places):
        x = left + j * cell + 10
        lines.append(f'<text x="{x}" y="{above - 6}" transform="rotate(-60 {x} {above - 6})">{escape(place)}</text>')
    for i, kind in enumerate(kinds):
        y = above + i * cell
        lines.append(f'<text x="{left - 6}" y="{y + 11}" text-anchor="end">{escape(kind)}</text>')
        total = counts[kind].total()
        for j, place in enumerate(places):
            share = counts[kind][place] / total
            if share:
                lines.append(f'<rect x="{left + j * cell}" y="{y}" width="{cell - 1}" height="{cell - 1}" '
                             f'fill="#1b4f72" fill-opacity="{0.08 + 0.92 * share:.3f}"/>')  # fmt: skip
    width, height = left + len(places) * cell + 90, above + len(kinds) * cell + 12
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif"'
    return "\n".join([head + ' font-size="10">', *lines, "</svg>"]) + "\n"


COLOURS = ("#1b4f72", "#d68910", "#1e8449")


def bar_chart(groups: Mapping[str, Counts], names: Sequence[str]) -> str:
    """Figure 5-4 as SVG: for each class a block of bars, whose lengths are the shares of conditions in each group."""
    left, wide, bar, gap = 110, 320, 11, 8
    lines: list[str] = []
    y = 34
    for k, group in enumerate(groups):
        x = left + 110 * k
        lines.append(f'<rect x="{x}" y="8" width="10" height="10" fill="{COLOURS[k % 3]}"/>')
        lines.append(f'<text x="{x + 14}" y="17">{escape(group)}</text>')
    for name in names:
        lines.append(f'<text x="8" y="{y + 12}" font-size="13" font-weight="bold">{escape(name)}</text>')
        y += 20
        kinds = sorted({kind for found in groups.values() for kind in found[name]})
        for kind in kinds:
            lines.append(f'<text x="{left - 6}" y="{y + bar - 2}" text-anchor="end">{escape(kind)}</text>')
            for k, found in enumerate(groups.values()):
                share = found[name][kind] / max(1, found[name].total())
                lines.append(f'<rect x="{left}" y="{y}" width="{wide * share:.1f}" height="{bar - 2}" '
                             f'fill="{COLOURS[k % 3]}"/>')  # fmt: skip
                lines.append(f'<text x="{left + wide * share + 4:.1f}" y="{y + bar - 3}">{share:.0%}</text>')
                y += bar
            y += gap
    head = f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + wide + 60}" height="{y + 8}"'
    return "\n".join([head + ' font-family="sans-serif" font-size="10">', *lines, "</svg>"]) + "\n"
