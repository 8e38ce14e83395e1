"""The places of others, for an agent that does not see them all the time."""

from __future__ import annotations

from random import Random

from hearth.agents.belief import Belief, Place
from hearth.simulation.observation.views import View
from hearth.simulation.world.bits import indices


def note_others(belief: Belief, view: View, chooser: Random) -> None:
    """Believe of each character that it is in the room where it was last seen; in any other room, once it is not there.

    Args:
        belief: gets the rooms.
        view: the current view.
        chooser: draws rooms.
    """
    home = view.world.home
    for other in view.others:
        if other.room is not None:
            belief.where[home.index[other.node]] = Place("INSIDE", home.index[other.room])
    for node in indices(home.characters & ~view.mask):
        place = belief.where.get(node)
        if place is None or home.ids[place.node] == view.me.room:
            rooms = [i for i in indices(home.rooms) if home.ids[i] != view.me.room]
            belief.where[node] = Place("INSIDE", chooser.choice(rooms))
