"""The nodes of which a relation or state may differ between two worlds of one home, as a bit set."""

from collections.abc import Iterable
from operator import attrgetter
from typing import Any

from hearth.schemas.literals import HANDS, HOLDS
from hearth.schemas.vocabulary import EVERY_STATE_ID
from hearth.simulation.world.agent import AGENT_IN, AGENT_OUT, Agent
from hearth.simulation.world.bits import indices
from hearth.simulation.world.moved_edges import BEARS, CLOSE, CONTENTS, FACED, FACING, INSIDE, ON
from hearth.simulation.world.state import WorldState


def _fields(*names: str) -> tuple[int, ...]:
    return tuple(Agent._fields.index(name) for name in names)


_FIELDS = {name: _fields(*{AGENT_OUT[name], AGENT_IN.get(name, AGENT_OUT[name])}) for name in AGENT_OUT} | {
    HOLDS: _fields(*(AGENT_OUT[hand] for hand in HANDS))
}
"""The positions of a relation's rows in an `Agent`."""

_KINDS = {"ON": (ON, BEARS), "INSIDE": (INSIDE, CONTENTS), "CLOSE": (CLOSE, CLOSE), "FACING": (FACING, FACED)}
"""The kinds of a relation's rows in `Moved`."""

_REMOVED = {name: attrgetter(name.lower()) for name in _KINDS}
"""The nodes removed from a relation, of a `Moved`."""


BY_PLACE = ("CLOSE", "FACING")
"""The relations of characters that follow where they are and look."""

_KEPT = slice(Agent._fields.index("inside"), Agent._fields.index("left") + 1)
"""The rows of an `Agent` of all other relations."""


def unchanged(before: WorldState, after: WorldState) -> bool:
    """Return whether no state and no relation but `BY_PLACE` of characters differs, as after most strides."""
    if before.states is not after.states or before.moved is not after.moved:
        return False
    for old, new in zip(before.agents, after.agents, strict=True):  # `all` takes twice as long
        if old is not new and old[_KEPT] != new[_KEPT]:
            return False
    return True


def changed(name: str, before: WorldState, after: WorldState) -> int:
    """Both ends of every edge of a relation that came or went, or the nodes whose state changed; maybe more."""
    number = EVERY_STATE_ID.get(name, len(before.states))
    if number < len(before.states) and before.states is not after.states:
        found = before.states[number] ^ after.states[number]
    else:
        found = 0
    if name in _FIELDS and before.agents is not after.agents:
        pairs: Iterable[tuple[Any, Any]] = zip(before.agents, after.agents, strict=True)
        for old, new in pairs:
            if old is not new:
                for field in _FIELDS[name]:
                    differing = old[field] ^ new[field]
                    if differing:
                        found |= differing | new.bit
    if name in _KINDS and before.moved is not after.moved:
        found |= _moved(name, before, after)
    return found


def _moved(name: str, before: WorldState, after: WorldState) -> int:
    kinds = _KINDS[name]
    old, new = before.moved, after.moved
    forward, backward = before.home.tables[name]
    found = 0
    for i in indices(_REMOVED[name](old) ^ _REMOVED[name](new)):
        found |= 1 << i | forward[i] | backward[i]
    if old.extra is not new.extra:
        for key, _ in old.extra.items() ^ new.extra.items():
            if key & 7 in kinds:
                found |= 1 << (key >> 3) | old.extra.get(key, 0) ^ new.extra.get(key, 0)
    return found
