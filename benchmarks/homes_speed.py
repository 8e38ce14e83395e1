"""Homes and sampling against the clock: `python benchmarks/homes_speed.py [SOURCE]`.

Processor time, the least of several runs of each piece of work: machines are shared.
"""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Iterable
from itertools import islice
from pathlib import Path
from time import process_time
from typing import Any

from hearth.grounding.base import prepared
from hearth.grounding.preconditions import infer
from hearth.grounding.sampling import Size, sample
from hearth.pipelines.rehearsal import Script, scripts
from hearth.pipelines.settings import Settings
from hearth.pipelines.surroundings import Homes
from hearth.schemas.failures import Failure
from hearth.simulation.homes import catalog
from hearth.simulation.homes.generate import generate
from hearth.simulation.homes.scene import scene

RUNS = 5
PROGRAMS = 60
CORPUS = Path(__file__).resolve().parents[1] / "data_raw" / "crowd"


def least(work: Callable[[], Any], runs: int = RUNS) -> float:
    """Seconds of processor time of the fastest run."""
    found = []
    for _ in range(runs):
        begun = process_time()
        work()
        found.append(process_time() - begun)
    return min(found)


def loading() -> Iterable[tuple[str, float]]:
    """Each of our homes from its plan, its files read and parsed anew."""

    def load(name: str) -> None:
        catalog._layout.cache_clear()
        catalog._scene.cache_clear()
        catalog.load_graph(name)

    for name in catalog.names():
        yield f"load {name}, ms", round(1000 * least(lambda name=name: load(name)), 1)


def drawing_up(count: int = 21) -> float:
    """Homes of 3 to 9 rooms in turn drawn up in a second, their graphs included."""
    seconds = sum(least(lambda seed=seed: scene(generate(3 + seed % 7, seed)), 3) for seed in range(count))
    return round(count / seconds, 1)


def sampling(programs: list[Script], homes: Homes, size: Size) -> tuple[float, int]:
    """Environments sampled and checked (conditions, soundness, a run) in a second, inference shared by all homes."""
    seconds, done = 0.0, 0
    for script in programs:
        conditions = infer(script.program, homes.knowledge)
        if isinstance(conditions, Failure):
            continue
        seconds += least(lambda script=script: infer(script.program, homes.knowledge))
        for name in homes.names():
            home = homes.home(name)
            seconds += least(lambda home=home, script=script, conditions=conditions: sample(
                script.program, home, 0, script.program_id, conditions, size))  # fmt: skip
            done += 1
    return round(done / seconds), done


def main() -> None:
    """Print every figure."""
    source = sys.argv[1] if len(sys.argv) > 1 else str(CORPUS)
    for name, value in loading():
        print(f"{name:44} {value}")
    print(f"{'homes drawn up a second':44} {drawing_up()}")
    homes = Homes(Settings())
    for name in homes.names():
        _ = prepared(homes.home(name)).fillers
    programs = list(islice((s for s in scripts([source], homes.knowledge) if isinstance(s, Script)), PROGRAMS))
    gc.collect()
    gc.freeze()
    for label, size in (("as they come", Size()), ("with 60 random things", Size(0, 0, 60))):
        rate, done = sampling(programs, homes, size)
        print(f"{f'environments a second, {label} ({done:,})':44} {rate:,}")


if __name__ == "__main__":
    main()
