"""Programs per second that are perturbed, placed, run and repaired on one core, and the share that can be repaired.

    python benchmarks/augment_speed.py [SOURCE...] [--programs N] [--pairs N]

Reading and loading homes and knowledge is not counted; sampling the original's environment is. The embedded
corpus, and the release's sample where there is one (HEARTH_REAL_DATA, else ../shared/real).
"""

from __future__ import annotations

import gc
import os
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import plain_reference
from measurement import Figure, Passes, as_line, finish, parser, passes, rate

from hearth.analysis.augmentation_results import GIVEN_UP
from hearth.analysis.programs_in_homes import Script, scripts
from hearth.grounding.environments.default_state import prepared
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.pipelines.build import corpus
from hearth.repair.augmentation import Options, augment
from hearth.schemas.failures import Code, Failure
from hearth.simulation.world.home import Home
from hearth.storage.rejects import Reject

ROOT = Path(__file__).resolve().parents[1]
REAL = Path(os.environ.get("HEARTH_REAL_DATA", ROOT.parent / "shared/real")) / "activityprograms-sample.zip"

GOAL = 400
"""Programs per second on one core."""


def measure(programs: Sequence[Script], homes: Sequence[Home], pairs: int) -> tuple[Counter[str], Passes]:
    """Outcomes of all pairs, by code (`""` for a new program), and their times."""
    outcomes: dict[int, list[str]] = {}
    options = Options(pairs)

    def one(number: int) -> None:
        script = programs[number]
        found = augment(script.program, homes[number % len(homes)], 0, script.program_id, options)
        if isinstance(found, Failure):
            outcomes[number] = [f"not sampled: {found.code}"]
        else:
            outcomes[number] = ["" if pair.failure is None else str(pair.failure.code) for pair in found.pairs]

    taken = passes(one, range(len(programs)))
    return Counter(code for codes in outcomes.values() for code in codes), taken


def report(name: str, programs: Sequence[Script], homes: Sequence[Home], pairs: int) -> list[Figure]:
    """Measure several times and print."""
    measure(programs[:20], homes, pairs)
    gc.collect()
    gc.freeze()
    outcomes, taken = measure(programs, homes, pairs)
    sampled = Counter({code: count for code, count in outcomes.items() if not code.startswith("not sampled")})
    repaired = sampled[""] + sampled[str(Code.DUPLICATE)]
    needed = repaired + sum(sampled[str(code)] for code in GIVEN_UP)
    counts = ", ".join(f"{code} {count}" for code, count in outcomes.most_common() if code)
    print(f"{name}: {len(programs)} programs, {sampled.total()} pairs; new programs {sampled['']}; {counts or '-'}")
    return [
        rate(f"{name}: pairs placed, perturbed, run, repaired", sampled.total(), taken, "pairs/s", GOAL,
             plain_reference.sampled_runs().ratio(sampled.total(), taken)),
        Figure(f"{name}: repaired of those that need it", 100 * repaired / max(1, needed), "%", 98),
    ]  # fmt: skip


def main() -> None:
    """Read the sources and report on each."""
    arguments = parser(__doc__)
    arguments.add_argument("sources", nargs="*", type=Path)
    arguments.add_argument("--programs", type=int, default=300)
    arguments.add_argument("--pairs", type=int, default=5)
    asked = arguments.parse_args()
    known = default()
    homes = [Home.from_graph(library.load_graph(name, default()), name, known) for name in library.names()]
    for home in homes:
        prepared(home)
    given = {str(path): [str(path)] for path in asked.sources}
    figures: list[Figure] = []
    for name, sources in (given or {"corpus": list(corpus()), "release sample": [str(REAL)]}).items():
        if not all(Path(source).exists() for source in sources):
            print(f"{name}: skipped, there is no {sources[0]}")
            continue
        found = [one for one in scripts(sources, known) if not isinstance(one, Reject)]
        step = max(1, len(found) // asked.programs)
        figures += report(name, found[::step][: asked.programs], homes, asked.pairs)
    for figure in figures:
        print(as_line(figure))
    finish(figures, asked.json)


if __name__ == "__main__":
    main()
