"""Drink, Eat, Cut, Pour."""

from hearth.schemas.failures import Code, Failure
from hearth.simulation.actions.common import (
    Action,
    Check,
    Masks,
    able,
    checked,
    close,
    free_hand,
    held,
    need_able,
    need_another,
    need_close,
    need_holding,
    refuse,
)
from hearth.simulation.actions.situation import Situation
from hearth.simulation.rules import Rules
from hearth.simulation.world import edge_rows
from hearth.simulation.world.agent import Agent
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.moved_edges import INSIDE, add
from hearth.simulation.world.world import World


def _need_food(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    """Refuse what is not eatable and bears nothing eatable."""
    eatable = world.home.properties["EATABLE"]
    if eatable >> o & 1 or edge_rows.bearing(world, o) & eatable:
        return None
    return refuse(world, Code.NOTHING_TO_EAT, "EATABLE, or something EATABLE on it", "neither", o)


def _with_food(s: Situation, action: str) -> int:
    """Food, and the close things that bear some."""
    food = s.home.properties["EATABLE"]
    return food | mask_of(i for i in indices(s.close & ~food) if edge_rows.bearing(s.world, i) & food)


def _need_knife(world: World, agent: Agent, o: int, action: str) -> Failure | None:
    if _knives(world, agent):
        return None
    return refuse(world, Code.NOT_HOLDING, "a knife in a hand", "none", o)


def _knives(world: World, agent: Agent) -> bool:
    return any("knife" in world.home.classes[i] for i in edge_rows.held_indices(agent))


def pour(world: World, number: int, o: int, s: int, rules: Rules) -> World | Failure:
    """Pour o into s; water leaves the hand, other things stay in it."""
    agent = world.agents[number]
    failure = (
        need_another(world, o, s)
        or need_able(world, agent, o, "Pour")
        or need_able(world, agent, s, "Pour", 1)
        or need_holding(world, agent, o)
        or need_close(world, agent, s, near_hands=rules.near_hands)
    )
    if failure is not None:
        return failure
    agents = world.agents
    if world.home.classes[o] == "water":
        rest = ~(1 << o)
        emptied = agent._replace(right=agent.right & rest, left=agent.left & rest)
        agents = world.with_agent(number, emptied).agents
    return World(world.home, world.states, agents, add(world.moved, (o, INSIDE, s)))


def _pourable(s: Situation) -> Masks:
    return s.able("Pour") & s.held, s.able("Pour", 1) & s.close


_food = Check(_need_food, _with_food)
_knife = Check(_need_knife, lambda s, _: -1 if _knives(s.world, s.me) else 0)

ACTIONS = (
    checked("Drink", able, held),
    checked("Eat", close, _food),
    checked("Cut", free_hand, close, able, _knife),
    Action("Pour", pour, _pourable),
)
