"""The main agent's beliefs about the places of wanted things in an episode, over time (thesis 6.4, figure B-3)."""

from collections import Counter
from collections.abc import Sequence
from typing import Any, NamedTuple

from hearth.agents.belief import Belief
from hearth.agents.subgoals import Aims
from hearth.analysis.object_distribution import heat_map
from hearth.challenges.tasks import Task
from hearth.schemas.rng import rng
from hearth.simulation.env import Tick
from hearth.simulation.observation.views import view
from hearth.simulation.world.bits import indices
from hearth.simulation.world.world import World

MOMENTS = 5
"""Number of moments to look at: the start, the end, and between."""


class Believed(NamedTuple):
    """Believed places of the things of one class at a tick: the expected number of them by class of place."""

    tick: int
    thing: str
    places: dict[str, float]

    def row(self) -> dict[str, Any]:
        """Return a row for a table: the most probable places first."""
        shown = sorted(self.places.items(), key=lambda each: (-each[1], each[0]))[:5]
        return {"tick": self.tick, "thing": self.thing, "believed": ", ".join(f"{p} {n:.2f}" for p, n in shown)}


def followed(task: Task, start: World, ticks: Sequence[Tick], moments: int = MOMENTS) -> list[Believed]:
    """Return the beliefs of an observer that gets the main agent's observations.

    Args:
        task: whose things are of interest.
        start, ticks: of an episode.
        moments: how many.
    """
    home = start.home
    aims = Aims(task.goal_in(home), home, home.agents[0])
    belief = Belief(home, aims.things, rng(task.seed, "belief"))
    worlds = [start, *(tick.world for tick in ticks)]
    chosen = {round(i * (len(worlds) - 1) / max(1, moments - 1)) for i in range(moments)}
    found = []
    for number, world in enumerate(worlds):
        belief.observe(view(world, 0, tick=number))
        if number in chosen:
            found += _now(number, belief, world)
    return found


def _now(tick: int, belief: Belief, world: World) -> list[Believed]:
    home = world.home
    counts: dict[str, Counter[str]] = {}
    for thing in indices(belief.things):
        for place, share in belief.probabilities(thing).items():
            name = "in hand" if home.characters >> place & 1 else home.classes[place]
            counts.setdefault(home.classes[thing], Counter())[name] += share  # type: ignore[assignment]
    return [Believed(tick, name, dict(places)) for name, places in sorted(counts.items())]


def drawn(found: Sequence[Believed]) -> str:
    """Return the belief as a picture, a row for each class of things and moment."""
    ordered = sorted(found, key=lambda each: (each.thing, each.tick))
    rows: dict[str, Counter[str]] = {}
    for each in ordered:
        rows[f"{each.thing}, tick {each.tick:03}"] = Counter(each.places)
    return heat_map(rows, "Where the main agent believes things to be (figure B-3)")
