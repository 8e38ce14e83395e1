"""What the films of a dataset show: the world at their start, and what is done by the classes of its objects."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from hearth.datasets.format.cases import start_of
from hearth.datasets.format.codecs import bindings_of, program_of
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import opened
from hearth.models.data import AT_ONCE
from hearth.models.interface import Steps
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef
from hearth.simulation.world.world import World

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset


class Shown(NamedTuple):
    """A film's execution: its world at the start, its steps by the classes of their nodes, and its activity."""

    world: World
    steps: Steps
    activity: str


def shown_films(dataset: Dataset, executions: Sequence[str]) -> list[Shown]:
    """What the films of some executions show, in their order."""
    homes, found = opened(str(dataset.folder))[1], {}
    for first in range(0, len(executions), AT_ONCE):
        for case in stored_cases(dataset, executions[first : first + AT_ONCE]):
            world = start_of(case["environment"], case["home"], homes)
            steps = program_of(case, bindings_of(case["bindings"])).steps
            found[case["execution_id"]] = Shown(world, by_class(steps, world), case["activity_id"])
    if missing := [name for name in executions if name not in found]:
        raise HearthError.of(Code.UNKNOWN_ID, f"a clip is of an unknown execution, `{missing[0][:80]}`")
    return [found[name] for name in executions]


def by_class(steps: Steps, world: World) -> Steps:
    """Steps with the classes of their nodes as names, as masks show them, and without nodes."""
    home = world.home

    def named(ref: ObjectRef) -> ObjectRef:
        return ObjectRef(home.classes[home.index[ref.node]] if ref.node in home.index else ref.name)

    return tuple(replace(step, objects=tuple(map(named, step.objects))) for step in steps)
