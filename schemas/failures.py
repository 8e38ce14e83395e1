"""Everything that can go wrong, as data: one enum of codes for parsing, checking, executing and sampling."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Code(StrEnum):
    """A failure's kind. Handlers, reports and scores look things up by it; nothing is parsed back from text."""

    # Reading
    EMPTY = "EMPTY"
    NOT_TEXT = "NOT_TEXT"
    LINE_TOO_LONG = "LINE_TOO_LONG"
    BAD_ARCHIVE = "BAD_ARCHIVE"
    BAD_JSON = "BAD_JSON"
    BAD_TABLE = "BAD_TABLE"
    BAD_GRAPH = "BAD_GRAPH"
    MISSING_FILE = "MISSING_FILE"
    UNSUPPORTED_FILE = "UNSUPPORTED_FILE"
    DUPLICATE = "DUPLICATE"
    REJECTED_ANSWER = "REJECTED_ANSWER"
    # Syntax and names
    SYNTAX = "SYNTAX"
    BAD_INSTANCE = "BAD_INSTANCE"
    UNKNOWN_ACTION = "UNKNOWN_ACTION"
    UNKNOWN_OBJECT = "UNKNOWN_OBJECT"
    UNKNOWN_HOME = "UNKNOWN_HOME"
    WRONG_ARITY = "WRONG_ARITY"
    SPECIAL_BLOCK = "SPECIAL_BLOCK"
    NOT_UNDERSTOOD = "NOT_UNDERSTOOD"
    AMBIGUOUS = "AMBIGUOUS"
    HEARD_NEARLY = "HEARD_NEARLY"
    # What an action is done to
    NOT_AFFORDED = "NOT_AFFORDED"
    NOT_SIMULATED = "NOT_SIMULATED"
    # What a program says as a whole
    NEAR_DUPLICATE = "NEAR_DUPLICATE"
    NO_EFFECT = "NO_EFFECT"
    OFF_TOPIC = "OFF_TOPIC"
    UNDECLARED = "UNDECLARED"
    # Where and how the character is
    NOT_CLOSE = "NOT_CLOSE"
    NOT_FACING = "NOT_FACING"
    NOT_IN_ROOM = "NOT_IN_ROOM"
    NO_ROOM = "NO_ROOM"
    SITTING = "SITTING"
    LYING = "LYING"
    NOT_SITTING_OR_LYING = "NOT_SITTING_OR_LYING"
    DOOR_CLOSED = "DOOR_CLOSED"
    NO_PATH = "NO_PATH"
    # Hands
    NO_FREE_HAND = "NO_FREE_HAND"
    NOT_HOLDING = "NOT_HOLDING"
    NO_ORIGIN = "NO_ORIGIN"
    HELD_BY_OTHER = "HELD_BY_OTHER"
    # The object's state
    OCCUPIED = "OCCUPIED"
    INSIDE_CLOSED = "INSIDE_CLOSED"
    IS_OPEN = "IS_OPEN"
    IS_CLOSED = "IS_CLOSED"
    IS_ON = "IS_ON"
    IS_OFF = "IS_OFF"
    IS_PLUGGED = "IS_PLUGGED"
    IS_UNPLUGGED = "IS_UNPLUGGED"
    NOT_OPENABLE_STATE = "NOT_OPENABLE_STATE"
    NOT_WORN = "NOT_WORN"
    NOTHING_TO_EAT = "NOTHING_TO_EAT"
    # Several agents
    CONFLICT = "CONFLICT"
    UNKNOWN_AGENT = "UNKNOWN_AGENT"
    # Grounding
    UNBOUND = "UNBOUND"
    CONTRADICTION = "CONTRADICTION"
    NO_PLACE = "NO_PLACE"
    CONDITION_UNMET = "CONDITION_UNMET"
    # Augmenting
    NO_HANDLER = "NO_HANDLER"
    HANDLER_ERROR = "HANDLER_ERROR"
    TOO_MANY_TRIES = "TOO_MANY_TRIES"
    LOOP = "LOOP"
    GOAL_LOST = "GOAL_LOST"
    UNPERTURBED = "UNPERTURBED"
    # Scoring and publishing
    UNKNOWN_ID = "UNKNOWN_ID"
    MISSING_PREDICTION = "MISSING_PREDICTION"
    REPLAY_DIFFERS = "REPLAY_DIFFERS"
    NOT_RENDERED = "NOT_RENDERED"
    # This machine, and Hearth itself
    FILE_TOO_LARGE = "FILE_TOO_LARGE"
    UNWRITABLE = "UNWRITABLE"
    LOCKED = "LOCKED"
    INTERNAL_ERROR = "INTERNAL_ERROR"
    DAMAGED_FILE = "DAMAGED_FILE"
    TIMED_OUT = "TIMED_OUT"


@dataclass(frozen=True, slots=True)
class Failure:
    """Why an instruction could not be done.

    Attributes:
        code: the kind.
        tick: which tick of the execution, from 0.
        agent: whose instruction.
        action: its canonical name.
        objects: node ids concerned, the offending one first.
        names: their classes, in the same order.
        expected: what had to hold.
        actual: what held instead.
    """

    code: Code
    tick: int = 0
    agent: int = 0
    action: str = ""
    objects: tuple[int, ...] = ()
    names: tuple[str, ...] = ()
    expected: str = ""
    actual: str = ""

    def message(self) -> str:
        """One line for people."""
        what = ", ".join(f"{name} ({node})" for name, node in zip(self.names, self.objects, strict=False))
        text = f"{self.code}: tick {self.tick + 1}, [{self.action}] {what}".rstrip()
        if self.expected:
            text += f"; expected {self.expected}"
        if self.actual:
            text += f", found {self.actual}"
        return text
