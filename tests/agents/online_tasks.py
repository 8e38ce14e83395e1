"""Tasks for helpers that do not know the goal: a toy grammar of goals, and episodes in which all see everything."""

from small_tasks import ALLOWED, wanted

from hearth.agents.human_like import HumanLike
from hearth.challenges.episode_loop import Player
from hearth.challenges.episode_loop import play as played_by
from hearth.schemas.goals import Goal
from hearth.schemas.literals import HOLDS, Literal
from hearth.simulation.world.bits import indices

COUNTS = {"plate": 3, "fork": 3, "apple": 3}


class Nobody:
    """Stands still."""

    def reset(self, observation, goal, seed):
        pass

    def act(self, observation, legal):
        return None


def play(world, goal, agents, seed=0, limit=250):
    """An episode in which everybody sees everything, and only the first knows the goal."""
    players = [Player(agents[0] or Nobody(), goal), Player(agents[1] or Nobody(), None)]
    return played_by(world, goal, players, seed, actions=ALLOWED, partial=False, limit=limit)


def goals_of(world):
    """A toy grammar: what may be wanted, with its probability."""
    return {
        wanted(world, "ON", "desk", plate=2): 0.3,
        wanted(world, "ON", "coffee_table", plate=1, fork=1): 0.3,
        wanted(world, "INSIDE", "fridge", apple=2): 0.2,
        wanted(world, "ON", "coffee_table", apple=1, fork=2): 0.2,
    }


def holding(world, name):
    """An environment in which the second character holds something."""
    goal = Goal.of(Literal(HOLDS, ("agent:1", name)))
    players = [Player(Nobody(), None), Player(HumanLike(), goal)]
    env = played_by(world, goal, players, 0, actions=ALLOWED, partial=False).env
    (thing,) = indices(env.world.agents[1].held)
    return env, thing
