"""A program while it is written: the scene, and steps of things that the scene declares."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import orjson

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.spoken_words import spoken
from hearth.schemas.syntax import print_object, print_step
from hearth.web.web_errors import WebError

SPECIAL = "Special"
MOST_STEPS, MOST_KINDS, MOST_PIECES, MOST_SPECIAL = 100, 60, 9, 200

MOST_KEPT = 2_000
"""Characters of a special block that are kept, though it is to be shortened before it is handed in."""

_PLAIN = re.compile(r"[^\W_](?:[\w ,.;:'’!?%/+=&-]*[\w.!?%)])?")


class Block(NamedTuple):
    """A step: an action with its things, None where a slot is empty; or a special block with free text.

    Attributes:
        action: canonical name, or `Special`.
        things: one for each slot.
        text: of a special block.
    """

    action: str
    things: tuple[ObjectRef | None, ...] = ()
    text: str = ""

    def line(self) -> str:
        """Return the step as program text; an empty slot is left out, which the check reports."""
        if self.action == SPECIAL:
            return f"[{SPECIAL}] <{self.text}>"
        return print_step(Step(self.action, tuple(filter(None, self.things))))

    def words(self, known: Knowledge, scene: Draft) -> str:
        """Return the step as a phrase, as its author sees it: `Put cup 1 on table`."""
        if self.action == SPECIAL:
            return f"Special: {self.text}"
        names = [scene.called(ref) if ref else "…" for ref in self.things]
        return known.actions[self.action].template.format(*names)


@dataclass(frozen=True, slots=True)
class Draft:
    """The scene and the program (thesis, figure 3-3).

    Attributes:
        rooms: kind of room -> how many.
        props: class -> how many.
        blocks: the steps.
    """

    rooms: dict[str, int]
    props: dict[str, int]
    blocks: tuple[Block, ...] = ()

    def lines(self) -> list[str]:
        """Return the steps as program text, one line each."""
        return [block.line() for block in self.blocks]

    def things(self) -> list[ObjectRef]:
        """Return every declared thing, rooms first."""
        both = [*self.rooms.items(), *self.props.items()]
        return [ObjectRef(name, number) for name, count in both for number in range(1, count + 1)]

    def called(self, thing: ObjectRef) -> str:
        """Return the words for a declared thing, with its number where the scene has several of the kind."""
        count = self.rooms.get(thing.name, 0) or self.props.get(thing.name, 0)
        return f"{spoken(thing.name)} {thing.instance}" if count > 1 else spoken(thing.name)

    def as_json(self) -> dict[str, Any]:
        """Return the draft as it is stored and sent."""
        steps = [
            {"special": block.text}
            if block.action == SPECIAL
            else {"action": block.action, "things": [ref and [ref.name, ref.instance] for ref in block.things]}
            for block in self.blocks
        ]
        return {"rooms": self.rooms, "props": self.props, "steps": steps}

    def dumped(self) -> str:
        """Return the draft as text for the store."""
        return orjson.dumps(self.as_json()).decode()

    def with_scene(self, rooms: dict[str, int], props: dict[str, int]) -> Draft:
        """Return the draft with another scene; slots whose thing is no longer declared become empty."""
        scene = Draft(rooms, props)
        left = set(scene.things())
        return replace(scene, blocks=tuple(
            block._replace(things=tuple(ref if ref in left else None for ref in block.things)) for block in self.blocks
        ))  # fmt: skip


def stored(text: str) -> Draft:
    """Return a draft as it was stored.

    Raises:
        HearthError: DAMAGED_FILE: it is none, as in a store that was changed by hand.
    """
    try:
        value = orjson.loads(text)
        return Draft(_counts(value["rooms"]), _counts(value["props"]), tuple(map(_stored_block, value["steps"])))
    except (orjson.JSONDecodeError, KeyError, TypeError, ValueError, AttributeError) as error:
        message = f"a program of the store is not one: {type(error).__name__} {str(error)[:80]}"
        raise HearthError.of(Code.DAMAGED_FILE, message) from error


def _counts(given: dict[str, Any]) -> dict[str, int]:
    if not all(isinstance(count, int) and 0 <= count <= MOST_PIECES for count in given.values()):
        raise ValueError(f"numbers of things {str(given)[:40]}")
    return given


def _stored_block(step: dict[str, Any]) -> Block:
    if "special" in step:
        return Block(SPECIAL, (), str(step["special"]))
    return Block(str(step["action"]), tuple(_stored_thing(*ref) if ref else None for ref in step["things"]))


def _stored_thing(name: str, instance: int) -> ObjectRef:
    return ObjectRef(str(name), int(instance))


def read_quantity(text: str, place: str) -> int:
    """Return a quantity from a form, from 0 to `MOST_PIECES`.

    Raises:
        WebError: BAD_ARGUMENT.
    """
    if not re.fullmatch(r"\s*\d?\s*", text, re.ASCII):
        raise WebError(Code.BAD_ARGUMENT, place, f"a number from 0 to {MOST_PIECES}", text[:20])
    return int(text.strip() or 0)


def read_blocks(value: Any, scene: Draft, known: Knowledge) -> tuple[Block, ...]:
    """Return the steps that a page sends: only declared things, and only actions that the grammar affords.

    Raises:
        WebError: BAD_ARGUMENT, UNKNOWN_ACTION, WRONG_ARITY, UNDECLARED or NOT_AFFORDED, with the step.
    """
    if not isinstance(value, list) or len(value) > MOST_STEPS:
        found = f"{len(value)} steps" if isinstance(value, list) else "none"
        raise WebError(Code.BAD_ARGUMENT, "steps", f"a list of at most {MOST_STEPS} steps", found)
    declared = set(scene.things())
    return tuple(_block(step, f"step {number}", declared, known) for number, step in enumerate(value, 1))


def _block(step: Any, place: str, declared: set[ObjectRef], known: Knowledge) -> Block:
    if isinstance(step, dict) and isinstance(step.get("special"), str):
        return Block(SPECIAL, (), _special(step["special"], place))
    name, things = (step.get("action"), step.get("things")) if isinstance(step, dict) else (None, None)
    action = known.actions.get(name) if isinstance(name, str) else None
    if action is None:
        raise WebError(Code.UNKNOWN_ACTION, place, "the name of an action", str(name)[:40])
    if not isinstance(things, list) or len(things) != action.arity:
        found = f"{len(things)}" if isinstance(things, list) else "none"
        raise WebError(Code.WRONG_ARITY, place, f"{action.arity} slots", found)
    refs = tuple(_thing(each, place, declared) for each in things)
    for slot, ref in enumerate(refs):
        if ref is not None and not known.affords(action.name, slot, ref.name):
            raise WebError(Code.NOT_AFFORDED, place, f"{action.name} of {action.grammar[slot]}", ref.name)
    filled = [ref for ref in refs if ref is not None]
    if len(set(filled)) < len(filled):
        raise WebError(Code.WRONG_ARITY, place, "different things", print_object(filled[0]))
    return Block(action.name, refs)


def _thing(value: Any, place: str, declared: set[ObjectRef]) -> ObjectRef | None:
    if value is None:
        return None
    if not (isinstance(value, list) and len(value) == 2 and isinstance(value[0], str) and type(value[1]) is int):
        raise WebError(Code.BAD_ARGUMENT, place, "a name and an instance, or nothing", str(value)[:40])
    ref = ObjectRef(value[0], value[1])
    if ref not in declared:
        raise WebError(Code.UNDECLARED, place, "a thing of the scene", print_object(ref)[:60])
    return ref


def is_plain(text: str) -> bool:
    """Return whether the free text of a special block can stand in a line of a program.

    Others are kept until handed in.
    """
    return len(text) <= MOST_SPECIAL and (not text or _PLAIN.fullmatch(text) is not None)


def _special(text: str, place: str) -> str:
    """Return the free text of a special block, with single spaces.

    Raises:
        WebError: BAD_ARGUMENT: it is longer than any person's.
    """
    text = " ".join(text.split())
    if len(text) > MOST_KEPT:
        raise WebError(Code.BAD_ARGUMENT, place, f"at most {MOST_KEPT:,} characters", f"{len(text):,}")
    return text
