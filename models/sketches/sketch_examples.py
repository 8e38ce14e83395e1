"""Programs with their sketches in their environments, as models of sketches learn from them (thesis 5.5.2)."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.row_conversion import bindings_of, program_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.interface import Request, Steps
from hearth.models.text_examples import Example
from hearth.schemas.rng import derive
from hearth.simulation.rules import RULES, Rules
from hearth.simulation.world.world import World

SHARE = 250
"""Executions read at a time."""


@dataclass(frozen=True, slots=True)
class Grounded:
    """A program bound to the nodes of an environment, in which it runs.

    Attributes:
        id: of the execution.
        sketch: the steps that the sketch keeps, bound.
        steps: all steps, bound.
        world: at the start.
        rules: of the engine.
        request: the title and the description.
    """

    id: str
    sketch: Steps
    steps: Steps
    world: World
    rules: Rules
    request: Request


def grounded(
    dataset: Dataset, examples: Sequence[Example], most: int = 0, seed: int = 0, own: str = ""
) -> Iterator[Grounded]:
    """Yield the executions of examples with a sketch, in the dataset's order.

    Args:
        dataset: with the executions.
        examples: programs; those without a sketch are left out.
        most: executions at most, a sample drawn from the seed; 0 for all.
        seed: of the sample.
        own: a name that distinguishes samples of one seed.
    """
    keeps = {name: each.keep for each in examples if any(each.keep) for name in each.executions}
    names = sorted(keeps, key=lambda name: derive(seed, "sample", own, name))[: most or None]
    names.sort()
    homes = opened(str(dataset.folder))[1]
    for first in range(0, len(names), SHARE):
        for case in stored_cases(dataset, names[first : first + SHARE]):
            steps = program_of(case, bindings_of(case["bindings"])).steps
            keep = keeps[case["execution_id"]]
            sketch = tuple(step for step, kept in zip(steps, keep, strict=False) if kept)
            world = start_of(case["environment"], case["home"], homes)
            request = Request(case["execution_id"], case["title"] or "", case["description"] or "")
            yield Grounded(case["execution_id"], sketch, steps, world, RULES[case["rules"]], request)
