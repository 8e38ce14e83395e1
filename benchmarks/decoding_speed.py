"""The cost of the engine in the loop: programs decoded with it and freely, by networks with random weights.

    python benchmarks/decoding_speed.py [--programs N]

Timed is the processor's time of the same steps at most; constrained programs must be at most twice as slow.
"""

from __future__ import annotations

from random import Random
from statistics import median
from time import process_time
from typing import Any

from measurement import Figure, as_line, finish, parser

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.models.decoding.search import Search, Start, decode
from hearth.models.interface import Request
from hearth.models.model_registry import MODELS, restore, settings_of
from hearth.models.sketches.graph_model import TrainedGraphModel
from hearth.models.sketches.name_numbers import Words
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

LONGEST = 15

TEXT = Request("", "Watch TV", "Turn on the TV, sit down on the couch and watch it.")


def worlds(number: int) -> list[World]:
    """Starts in our homes, by turns."""
    known = default()
    names = ("birch", "cedar", "juniper", "larch", "maple", "rowan", "willow")
    homes = [Home.from_graph(library.load_graph(name, known), name, known) for name in names]
    return [World.start(homes[n % len(homes)]) for n in range(number)]


def graph_model(name: str) -> TrainedGraphModel:
    """A model of table 5.2 with random weights."""
    import torch

    torch.manual_seed(0)
    known = default()
    settings: Any = settings_of(name)
    words = Words.of(known)
    actions = tuple(sorted(each for each, action in known.actions.items() if action.executed))
    return TrainedGraphModel(settings, words, actions, settings.network(words, actions).eval())


def seconds(scorer: Any, starts: list[Start], constrained: bool) -> tuple[float, int]:
    """Of the processor for these programs, and their steps."""
    began = process_time()
    programs = decode(scorer, starts, Search(constrained=constrained, longest=LONGEST, least=LONGEST))
    return process_time() - began, sum(map(len, programs))


def compared(name: str, scorer: Any, given: Any, number: int) -> Figure:
    """Return the ratio of the times of constrained and free decoding, for a step; the median of three turns."""
    starts = [Start(world, given, Random(n)) for n, world in enumerate(worlds(number))]
    ratios = []
    for _ in range(3):
        (free, steps), (masked, others) = (seconds(scorer, starts, constrained) for constrained in (False, True))
        ratios.append((masked / max(1, others)) / (free / max(1, steps)))
    return Figure(f"{name}: constrained, in times of free (at most 2)", median(ratios), "times")


def main() -> None:
    """Measure."""
    options = parser(__doc__)
    options.add_argument("--programs", type=int, default=28)
    asked = options.parse_args()
    sketch = (Step("SwitchOn", (ObjectRef("television", 1),)), Step("Sit", (ObjectRef("couch", 1),)))
    found = []
    for name, entry in MODELS.items():
        if "graph_model" in entry.place:
            found.append(compared(name, graph_model(name).scorer(), sketch, asked.programs))
            print(as_line(found[-1]), flush=True)
    written: Any = restore("mle-composed")[1]
    found.append(compared("mle-composed", written.scorer(), TEXT, asked.programs))
    print(as_line(found[-1]))
    finish(found, asked.json)


if __name__ == "__main__":
    main()
