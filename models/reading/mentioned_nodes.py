"""The things of a home that mentions speak of; without a home, classes with numbers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from functools import lru_cache

from hearth.kb.knowledge import Knowledge
from hearth.models.reading.mentions import EVERY, SEVERAL, Mention
from hearth.schemas.program import ObjectRef
from hearth.schemas.vocabulary import EVERY_STATE_ID, OPPOSITE, STATE_ID
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.world import World

MOST = 40
"""Things of one mention at most: a request for more is refused, as its program would take all day."""

MOST_CARRIED = 3
"""Things that a plural without a number means, where they are carried."""

MOST_HELD = 2
"""Things that a plural without a number means, where they are only taken: there are two hands."""

Refs = tuple[ObjectRef, ...]


@lru_cache(maxsize=65_536)
def fits(known: Knowledge, name: str, needs: frozenset[str]) -> bool:
    """Return whether a class has one of some properties, or is of one of some kinds or classes; of none after a `!`."""
    if not needs:
        return True
    thing = known.objects.get(name)
    if thing is None:
        return False
    kinds = {name, *known.same_class(name)[:1], *known.ancestors(name)}
    if any(known.has(name, need[1:]) or need[1:] in kinds for need in needs if need[0] == "!"):
        return False
    if all(need[0] == "!" for need in needs):
        return True
    return not needs.isdisjoint(kinds) or any(known.has(name, need) for need in needs) or _is_room(known, name, needs)


def _is_room(known: Knowledge, name: str, needs: Collection[str]) -> bool:
    return "room" in needs and known.is_room(name)


_GONE = EVERY_STATE_ID["GONE"]


class Scene:
    """A home at the start of a request, or none: things by mention, and the numbers of those that were spoken of.

    Attributes:
        avoided: classes that `some` passes over, such as those of things not to be used.
        room: the room that was spoken of last, in which things without a place are looked for first; -1 where none was.
    """

    def __init__(self, known: Knowledge, world: World | None) -> None:
        self.known, self.world = known, world
        self.numbers: dict[str, list[int]] = {}
        self.avoided: frozenset[str] = frozenset()
        self.room = -1

    def has(self, name: str) -> bool:
        """Return whether there is a thing of a class; without a home, there is one of each."""
        return self.world is None or self.world.home.instances(name) != 0

    def things(self, mention: Mention, needs: frozenset[str], action: str = "") -> Refs:
        """Return the things of a mention that fit, as many as it counts; none where there are fewer.

        Args:
            mention: not of a pronoun.
            needs: properties, kinds or classes of which they have one.
            action: what is done with them; the things for which that changes something come first.
        """
        self.speak_of_rooms([name for _, names in mention.places for name in names] or mention.classes[:1])
        classes = [name for name in mention.classes if fits(self.known, name, needs)]
        if self.world is None:
            return tuple(ObjectRef(classes[0], n) for n in range(1, max(mention.count, 1) + 1)) if classes else ()
        if classes and self._is_other(classes[0], mention):
            return ()
        found = self._nodes(classes, mention)
        left_out = {node for other in mention.others for node in self._nodes(other.classes, other)}
        ordered = self._ordered([node for node in found if node not in left_out], action)
        if mention.count > 0:
            ordered = ordered[: mention.count] if len(ordered) >= mention.count else []
        else:
            ordered = self._to_change(ordered, action)
            if mention.count == SEVERAL and self._is_carried(ordered):
                ordered = ordered[: MOST_CARRIED if action != "Grab" else MOST_HELD]
        return tuple(map(self._ref, ordered)) if len(ordered) <= MOST else ()

    def speak_of_rooms(self, names: Sequence[str]) -> None:
        """Note the room that is spoken of, where the home has one room of these classes."""
        if self.world is None:
            return
        rooms = [i for name in names if self.known.is_room(name) for i in indices(self.world.home.instances(name))]
        if len(rooms) == 1:
            self.room = rooms[0]

    def _is_other(self, name: str, mention: Mention) -> bool:
        """Return whether a class would take the place of one that the home has, but that does not fit."""
        first = mention.classes[0]
        return name != first and name in self.known.stand_ins(first) and self.has(first)

    def _to_change(self, nodes: list[int], action: str) -> list[int]:
        """Return the things on which an act changes something; all where it changes none."""
        assert self.world is not None
        state = self.known.state_of(action) if action else ""
        done = self.world.states[STATE_ID[state]] if state in STATE_ID and state in OPPOSITE else 0
        return [i for i in nodes if not done >> i & 1] or nodes

    def some(self, names: Sequence[str], count: int, taken: Collection[int] = ()) -> Refs:
        """Return a number of things of the first class of which the home has enough."""
        if self.world is None:
            return tuple(ObjectRef(names[0], n) for n in range(1, count + 1))
        for name in names:
            found = (i for i in self._named(name) if i not in taken)
            nodes = self._ordered([i for i in found if self.world.home.classes[i] not in self.avoided], "")
            if len(nodes) >= count:
                return tuple(map(self._ref, nodes[:count]))
        return ()

    def _named(self, name: str) -> list[int]:
        """Return the nodes of a class; those that a home has in its place only where it has none of its own."""
        assert self.world is not None
        every = list(indices(self.world.home.instances(name) & ~self._absent()))
        return [i for i in every if self.world.home.classes[i] == name] or every

    def _absent(self) -> int:
        """Return the things that are in no room: used up, or parts that come about by cutting."""
        assert self.world is not None
        states = self.world.states
        return self.world.home.absent | (states[_GONE] if len(states) > _GONE else 0)

    def others(self, refs: Refs, taken: Collection[int]) -> Refs:
        """Return another thing of the class of some things, none of those that are taken."""
        if self.world is None:
            return (ObjectRef(refs[0].name, len(refs) + 1),)
        nodes = [i for i in indices(self.world.home.instances(refs[0].name)) if self.world.home.ids[i] not in taken]
        return tuple(map(self._ref, self._ordered(nodes, "")[:1]))

    def support(self, ref: ObjectRef) -> Refs:
        """Return the furniture that a thing stands on; none where it is on nothing, and without a home."""
        if self.world is None:
            return ()
        surfaces = self.world.home.properties["SURFACES"] & ~self.world.home.properties["GRABBABLE"]
        return tuple(self._ref(i) for i in indices(edge_rows.on(self.world, self.index(ref)) & surfaces))[:1]

    def contents(self, refs: Refs) -> Refs:
        """Return the movable things in some furniture; none without a home."""
        if self.world is None:
            return ()
        movable = self.world.home.properties["GRABBABLE"]
        inside = (edge_rows.contents(self.world, self.index(ref)) & movable for ref in refs)
        return tuple(self._ref(i) for mask in inside for i in indices(mask))

    def _is_carried(self, nodes: Iterable[int]) -> bool:
        assert self.world is not None
        movable = self.world.home.properties["GRABBABLE"]
        return all(movable >> node & 1 for node in nodes)

    def _nodes(self, classes: Sequence[str], mention: Mention) -> list[int]:
        """Return the nodes of the first class that the home has where it is said, or of all classes of a plural."""
        assert self.world is not None
        found: list[int] = []
        is_all = mention.count <= 0 and mention.is_group
        if mention.count > 1:  # six glasses are six of one class, where the home has as many
            enough = [name for name in classes if len(self._named(name)) >= mention.count]
            classes = [*enough, *(name for name in classes if name not in enough)]
        for is_placed in (True, False) if mention.places else (False,):
            for name in classes:
                nodes = [i for i in self._named(name) if i not in found]
                found += [i for i in nodes if not is_placed or self._is_at(i, mention)]
                if not is_all and len(found) >= max(mention.count, 1):
                    return found
                if mention.count <= 0 and not mention.is_group:
                    found = []  # all cups are not all mugs, too
            if found:
                return found
            if is_placed and any(self._is_room_place(names) for _, names in mention.places):
                every = [i for name in classes for i in indices(self.world.home.instances(name))]
                return every if len(every) == 1 else []  # a lamp of the bedroom is none of the kitchen
        return found

    def _is_room_place(self, names: Sequence[str]) -> bool:
        return any(self.known.is_room(name) for name in names)

    def _is_at(self, node: int, mention: Mention) -> bool:
        return all(self._is_in_place(node, relation, names) for relation, names in mention.places)

    def _is_in_place(self, node: int, relation: str, names: Sequence[str]) -> bool:
        assert self.world is not None
        home = self.world.home
        if self._is_room_place(names):
            rooms = next((mask for name in names if self.known.is_room(name) and (mask := home.instances(name))), 0)
            return bool(rooms & self._rooms_of(node))
        places = mask_of(i for name in names for i in indices(home.instances(name)))
        if relation == "INSIDE":
            return bool(edge_rows.inside(self.world, node) & places)
        on = bool(edge_rows.on(self.world, node) & places)
        if relation == "ON":
            return on or bool(edge_rows.inside(self.world, node) & places)
        return on or any(
            edge_rows.room_of(self.world, i) == edge_rows.room_of(self.world, node) for i in indices(places)
        )

    def _rooms_of(self, node: int) -> int:
        """Return the rooms of a thing: a door or a window between two rooms is of both."""
        assert self.world is not None
        home = self.world.home
        room = edge_rows.room_of(self.world, node)
        return (1 << room if room >= 0 else 0) | (home.between[node] if node < len(home.between) else 0)

    def _ordered(self, nodes: list[int], action: str) -> list[int]:
        assert self.world is not None
        world = self.world
        state = self.known.state_of(action) if action else ""
        done = world.states[STATE_ID[state]] if state in STATE_ID and state in OPPOSITE else 0
        here = edge_rows.agent_room(world, world.agents[0]) if world.agents else -1
        spoken = 1 << self.room if self.room >= 0 else 0
        return sorted(
            nodes,
            key=lambda i: (
                bool(spoken) and not self._rooms_of(i) & spoken,
                done >> i & 1,
                edge_rows.room_of(world, i) != here,
            ),
        )

    def _ref(self, node: int) -> ObjectRef:
        assert self.world is not None
        home = self.world.home
        name, number = home.classes[node], home.ids[node]
        known = self.numbers.setdefault(name, [])
        if number not in known:
            known.append(number)
        return ObjectRef(name, known.index(number) + 1, number)

    def index(self, ref: ObjectRef) -> int:
        """Return the index of a thing's node; -1 without a home."""
        return self.world.home.index[ref.node] if self.world and ref.node is not None else -1


__all__ = ["EVERY", "MOST", "SEVERAL", "Refs", "Scene", "fits"]
