"""The planner as a model: a sketch's steps bound to the nearest nodes, repaired until they run; nothing is learned.

It is the yardstick of table 5.2: it runs always and reaches half of the goals.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hearth.models.interface import Request, Settings, Steps, Training
from hearth.repair.sketch_plan import planned_program
from hearth.storage.parallel import Seen, unseen

if TYPE_CHECKING:
    from hearth.models.checkpoint import Checkpoint
    from hearth.models.text_examples import Corpus


@dataclass(frozen=True, slots=True)
class Planner(Settings):
    """The planner as a model: it needs no training."""

    def fit(self, corpus: Corpus, how: Training, seen: Seen = unseen) -> Planner:
        """Itself."""
        return self

    @classmethod
    def restored(cls, checkpoint: Checkpoint) -> Planner:
        """Itself."""
        return cls()

    def predict(self, requests: Sequence[Request], beam: int = 1) -> list[Steps]:
        """Return the plan for each sketch in its world; no steps without a world."""
        return [planned_program(each.sketch, each.world, each.rules) if each.world else () for each in requests]

    def checkpoint(self) -> Checkpoint:
        """Return a checkpoint without weights."""
        from hearth.models.checkpoint import Checkpoint

        return Checkpoint("planner", {}, {}, {})
