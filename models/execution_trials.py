"""Executions of a dataset as places to try programs in: whether a program runs there, as scores tell it."""

from collections.abc import Sequence
from dataclasses import dataclass

from hearth.datasets.dataset import Dataset
from hearth.datasets.format.case_rows import start_of
from hearth.datasets.format.row_conversion import bindings_of, program_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.interface import Steps
from hearth.models.text_examples import AT_ONCE
from hearth.schemas.program import Program
from hearth.scoring.metrics.executability import executability
from hearth.simulation.rules import RULES, Rules
from hearth.simulation.world.world import World


@dataclass(frozen=True, slots=True)
class Trial:
    """An execution as a place to try other programs in.

    Attributes:
        world: at its start.
        reference: its program, bound; it guides the binding of others, as in scores.
        rules: by which it ran.
        activity: its id.
    """

    world: World
    reference: Program
    rules: Rules
    activity: str = ""

    def runs(self, steps: Steps) -> bool:
        """Return whether a program is executable here, as `score dataset` measures it; the empty program is not."""
        return bool(steps) and executability(steps, self.world, self.reference, self.rules).executable


def trials(dataset: Dataset, names: Sequence[str]) -> dict[str, Trial]:
    """Return some executions by id; unknown ones are left out."""
    homes, found = opened(str(dataset.folder))[1], {}
    for first in range(0, len(names), AT_ONCE):
        for case in stored_cases(dataset, names[first : first + AT_ONCE]):
            world = start_of(case["environment"], case["home"], homes)
            reference = program_of(case, bindings_of(case["bindings"]))
            found[case["execution_id"]] = Trial(world, reference, RULES[case["rules"]], case["activity_id"])
    return found
