"""Homes and sampling against the clock: `python benchmarks/homes_speed.py [SOURCE] [--homes DIR] [--json FILE]`.

Every figure is the median of several passes over all the work: a whole source in all homes, with inference, sampling,
all checks and the run to the end. Work done once per home is measured separately.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from time import process_time

import plain_reference
from measurement import Figure, as_line, finish, parser, passes, rate, runs, seconds, stalls

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.homes import library
from hearth.homes.from_graph.graph_layout import lay_out
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.failures import Failure

CORPUS = Path(__file__).resolve().parents[1] / "data_raw" / "crowd"
SIZES = (("as they come", Size()), ("of 280 to 300 nodes", Size.about(290)))


def loading() -> Figure:
    """All our homes, read and parsed from their plans."""

    def load() -> None:
        library._layout.cache_clear()
        library._scene.cache_clear()
        for name in library.names():
            library.load_graph(name, default())

    names = library.names()
    taken = [s / len(names) for s in runs(load, 3)]
    ratio = plain_reference.written_home().ratio(1, taken)
    return seconds(f"one of {len(names)} designed homes, read and built", taken, "ms", ratio=ratio)


def drawing_up(count: int = 21) -> Figure:
    """Procedural homes of 3 to 9 rooms generated per second, including their graphs."""

    taken = passes(lambda seed: scene(generate(3 + seed % 7, seed, default()), default()), range(count))
    ratio = plain_reference.written_home().ratio(count, taken)
    return rate("procedural homes drawn up, with their graphs", count, taken, "homes/s", 20.0, ratio)


def laying_out(homes: Path) -> Figure:
    """Layouts of the graphs of a folder."""
    graphs = [(path.stem, library.graph_of(path, default())) for path in sorted(homes.glob("*.json"))]
    taken = [
        s for name, graph in graphs for s in runs(lambda name=name, graph=graph: lay_out(graph, name, default()), 1)
    ]
    return seconds(f"a layout for one of {len(graphs)} scene graphs", taken, "s")


def sampling(programs: list[Script], homes: Homes, label: str, size: Size, times: int) -> Figure:
    """Environments sampled and checked (conditions, soundness, a run) per second; inference is shared by all homes."""
    done: dict[str, int] = {}

    def everywhere(script: Script) -> None:
        conditions = infer(script.program, homes.knowledge)
        if isinstance(conditions, Failure):
            return
        drawn = [
            sample(script.program, homes.home(name), 0, script.program_id, conditions, size) for name in homes.names()
        ]
        done[script.program_id] = sum(not isinstance(found, Failure) for found in drawn)

    taken = passes(everywhere, programs, times)
    count = sum(done.values())
    ratio = plain_reference.sampled_runs().ratio(count, taken)
    return rate(f"environments {label}, sampled and checked ({count:,})", count, taken, "environments/s", 1000.0, ratio)


def figures(source: str, folder: Path | None, limit: int | None, times: int) -> Iterator[Figure]:
    """Every figure."""
    yield stalls()
    yield loading()
    yield drawing_up()
    if folder is not None:
        yield laying_out(folder)
    homes = Homes(Settings(homes_folder=str(folder) if folder else None))
    began = process_time()
    for name in homes.names():
        for _, size in SIZES:
            _ = size.base(homes.home(name)).fillers
    names = len(homes.names())
    yield seconds(f"making one of {names} homes ready, once", [(process_time() - began) / names], "ms")
    programs = list(islice((s for s in scripts([source], homes.knowledge) if isinstance(s, Script)), limit))
    gc.collect()
    gc.freeze()
    for label, size in SIZES:
        yield sampling(programs, homes, label, size, times)
    yield stalls()


def main() -> None:
    """Print every figure."""
    arguments = parser(__doc__)
    arguments.add_argument("source", nargs="?", default=str(CORPUS), help="programs; the embedded corpus if none")
    arguments.add_argument("--homes", type=Path, metavar="DIR", help="further homes")
    arguments.add_argument("--limit", type=int, metavar="N", help="at most N programs")
    arguments.add_argument("--times", type=int, default=5, metavar="N", help="passes")
    asked = arguments.parse_args()
    found = []
    for figure in figures(asked.source, asked.homes, asked.limit, asked.times):
        found.append(figure)
        print(as_line(figure))
        sys.stdout.flush()
    finish(found, asked.json)


if __name__ == "__main__":
    main()
