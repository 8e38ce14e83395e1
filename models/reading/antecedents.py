"""Antecedents: the things of words before that `it`, `them`, `another` and `the door` stand for."""

from __future__ import annotations

from collections.abc import Sequence

from hearth.models.reading.mentioned_nodes import Refs, Scene, fits
from hearth.models.reading.mentions import Mention
from hearth.models.reading.request_table import acts_of
from hearth.models.reading.spoken_things import Spoken

_CLOSE = "Close"
_TOOLS = frozenset({"cleaning_tool", "cleaning_agent", "towel"})
_ROOM = frozenset({"room"})
MANY = frozenset(
    {
        "them",
        "they",
        "both",
        "the both",
        "the two",
        "them both",
        "them all",
        "both of them",
        "all of them",
        "these",
        "those",
        "all",
    }
)
"""Pronouns of several things."""

DOORS = frozenset({"the door", "the doors", "its door", "the lid", "door"})
"""Words for the door of the furniture that was spoken of last."""

_HAS_DOOR = ("CAN_OPEN", "CONTAINERS")
_HAS_LID = ("CAN_OPEN",)
_OPENS = frozenset({"CAN_OPEN", "HAS_SWITCH"})


class Antecedents:
    """Finds what words that refer back stand for, among the things spoken of before.

    Attributes:
        scene: the home.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene, self.known = scene, scene.known

    def another(self, needs: frozenset[str], spoken: Sequence[Spoken]) -> Refs:
        """Return another thing of the kind that was spoken of last."""
        groups = [each.refs for each in spoken if not each.is_place]
        refs = next((each for each in groups if all(fits(self.known, ref.name, needs) for ref in each)), ())
        taken = {ref.node for each in spoken for ref in each.refs if ref.node is not None}
        return self.scene.others(refs, taken) if refs else ()

    def meant_before(self, mention: Mention, spoken: Sequence[Spoken]) -> Refs:
        """Return the thing of a class of several that was spoken of before: `the pan` is the frying pan."""
        is_definite = mention.count == 1 and not mention.places and mention.words.startswith(("the ", "that ", "this "))
        if not is_definite or len(mention.classes) < 2 or self.scene.world is None:
            return ()
        first, stand_ins = mention.classes[0], self.known.stand_ins(mention.classes[0])
        own = [name for name in mention.classes if not (name in stand_ins and self.scene.has(first))]
        return next((each.refs for each in spoken if len(each.refs) == 1 and each.refs[0].name in own), ())

    def opened(self, spoken: Sequence[Spoken], words: str) -> Refs:
        """Return the furniture that was spoken of last, where it has a door of its own."""
        if words.startswith("its "):
            return next((each.refs for each in spoken if self.known.has(each.refs[0].name, "CAN_OPEN")), ())
        is_furniture = spoken and (spoken[0].is_place or spoken[0].action == "Open" or words == "the lid")
        last = spoken[0].refs if is_furniture else ()
        needs = _HAS_LID if words == "the lid" else _HAS_DOOR
        return last if all(self.known.has(ref.name, need) for ref in last for need in needs) else ()

    def referred(self, needs: frozenset[str], action: str, spoken: Sequence[Spoken], *, is_many: bool = False) -> Refs:
        """Return the things of words before that `it` or `them` stands for."""
        groups = list(spoken[:1] if needs == _ROOM else spoken)
        if action in acts_of("cleaned"):
            groups.sort(key=lambda each: each.action == "Grab" and self._is_tool(each))
        if action == _CLOSE:
            groups.sort(key=lambda each: (each.action != "Open", not each.is_place))
        elif needs.isdisjoint(_OPENS):
            groups.sort(key=lambda each: each.is_place)
        if is_many:
            groups.sort(key=lambda each: len(each.refs) < 2)
        return next((each.refs for each in groups if all(fits(self.known, ref.name, needs) for ref in each.refs)), ())

    def _is_tool(self, spoken: Spoken) -> bool:
        return all(fits(self.known, ref.name, _TOOLS) for ref in spoken.refs)
