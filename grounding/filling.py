"""Random common-sense objects, so that no two environments are the same (KB-RealEnv, thesis 5.5.2)."""

from __future__ import annotations

from bisect import bisect_right

from hearth.grounding.draft import Draft
from hearth.schemas.vocabulary import FIRST_FILLED_ID, OPPOSITE


def fill(draft: Draft, least: int, most: int, some: int) -> None:
    """Add random loose things where they belong.

    Args:
        draft: to add to.
        least, most: nodes the environment should have; the number is drawn from between.
        some: things added all the same to a home that has as many already.
    """
    base = draft.base
    choices, weights = base.fillers
    if not weights:
        return
    rng = draft.rng
    present = len(base.home) + len(draft.nodes)
    wanted = max(rng.randint(least, most) - present, rng.randint(1, some))
    total = weights[-1]
    home = base.home
    for _ in range(wanted):
        name, i, relation = choices[bisect_right(weights, rng.random() * total)]
        place = home.ids[i]
        if place in draft.taken or _is_full(draft, i, place):
            continue
        room = base.room[i]
        node_id = draft.add(name, home.ids[room] if room >= 0 else -1, FIRST_FILLED_ID)
        draft.put(node_id, relation, place)
        _random_states(draft, node_id)


def _is_full(draft: Draft, i: int, place: int) -> bool:
    home = draft.base.home
    if not (home.properties["SITTABLE"] | home.properties["LIEABLE"]) >> i & 1:
        return False
    return draft.crowd(place) + 1 >= home.limit(i)


def _random_states(draft: Draft, node_id: int) -> None:
    """Any of its pairs of states, turned over one time in four."""
    for state in draft.new[node_id].states:
        if draft.rng.random() < 0.25:
            draft.set_state(node_id, OPPOSITE[state])
