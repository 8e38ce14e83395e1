"""The contents of a dataset's films: the world at their start, and their steps by the classes of the objects."""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

from hearth.datasets.dataset import Dataset
from hearth.models.execution_trials import Trial, trials
from hearth.models.interface import Steps
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef
from hearth.simulation.world.world import World


class Shown(NamedTuple):
    """A film's execution, and its steps by the classes of their nodes."""

    trial: Trial
    steps: Steps

    @property
    def world(self) -> World:
        """Return the world at the start."""
        return self.trial.world


def shown_films(dataset: Dataset, executions: Sequence[str]) -> list[Shown]:
    """Return the contents of the films of some executions, in their order."""
    found = trials(dataset, executions)
    if missing := [name for name in executions if name not in found]:
        raise HearthError.of(Code.UNKNOWN_ID, f"a clip is of an unknown execution, `{missing[0][:80]}`")
    return [Shown(found[name], by_class(found[name].reference.steps, found[name].world)) for name in executions]


def by_class(steps: Steps, world: World) -> Steps:
    """Return steps with the classes of their nodes as names, as masks show them, and without nodes."""
    home = world.home

    def named(ref: ObjectRef) -> ObjectRef:
        return ObjectRef(home.classes[home.index[ref.node]] if ref.node in home.index else ref.name)

    return tuple(replace(step, objects=tuple(map(named, step.objects))) for step in steps)
