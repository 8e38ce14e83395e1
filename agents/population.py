"""People to be helped who are unlike the one that helpers were tuned with (an open question of thesis 7.6)."""

from __future__ import annotations

from collections.abc import Callable

from hearth.agents.faults import Faults, Faulty
from hearth.schemas.program import Step
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View


class Slow(Faulty):
    """Does something in every other tick only."""

    def __init__(self) -> None:
        super().__init__(Faults())

    def act(self, observation: View, legal: Legal) -> Step | None:
        """As the human-like agent, or nothing."""
        return None if observation.tick % 2 else super().act(observation, legal)


class NearSighted(Faulty):
    """Sees only what is around it, where all others see the whole home, and forgets where things were."""

    near_sighted = True

    def __init__(self) -> None:
        super().__init__(Faults(forgetting=0.02))


PEOPLE: dict[str, Callable[[], Faulty]] = {
    "changes_mind": lambda: Faulty(Faults(change_of_mind=0.1)),
    "careless": lambda: Faulty(Faults(mistake=0.15, leaving_open=1.0)),
    "distracted": lambda: Faulty(Faults(distractor=0.03, detour=0.03)),
    "slow": Slow,
    "near_sighted": NearSighted,
}
"""Kinds of main agents that no setting of a helper was tuned with."""
