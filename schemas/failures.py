"""Everything that can go wrong, as data: one enum of codes for parsing, checking, executing and sampling."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Self


class Code(StrEnum):
    """A failure's kind. Handlers, reports and scores look things up by it; nothing is parsed back from text.

    Attributes:
        number: the published id, which never changes: a new code gets the next number, a removed one leaves a gap.
    """

    number: int

    def __new__(cls, name: str, number: int) -> Self:
        """Return a code that equals its name; `Code["EMPTY"]` finds it again."""
        code = str.__new__(cls, name)
        code._value_, code.number = name, number
        return code

    # Reading
    EMPTY = "EMPTY", 0
    NOT_TEXT = "NOT_TEXT", 1
    LINE_TOO_LONG = "LINE_TOO_LONG", 2
    BAD_ARCHIVE = "BAD_ARCHIVE", 3
    BAD_JSON = "BAD_JSON", 4
    BAD_TABLE = "BAD_TABLE", 5
    BAD_GRAPH = "BAD_GRAPH", 6
    MISSING_FILE = "MISSING_FILE", 7
    UNSUPPORTED_FILE = "UNSUPPORTED_FILE", 8
    DUPLICATE = "DUPLICATE", 9
    REJECTED_ANSWER = "REJECTED_ANSWER", 10
    # Syntax and names
    SYNTAX = "SYNTAX", 11
    BAD_INSTANCE = "BAD_INSTANCE", 12
    UNKNOWN_ACTION = "UNKNOWN_ACTION", 13
    UNKNOWN_OBJECT = "UNKNOWN_OBJECT", 14
    UNKNOWN_HOME = "UNKNOWN_HOME", 15
    WRONG_ARITY = "WRONG_ARITY", 16
    SPECIAL_BLOCK = "SPECIAL_BLOCK", 17
    NOT_UNDERSTOOD = "NOT_UNDERSTOOD", 18
    AMBIGUOUS = "AMBIGUOUS", 19
    FUZZY_MATCH = "FUZZY_MATCH", 20
    NO_STEP = "NO_STEP", 84
    HEARD_NEARLY = "FUZZY_MATCH", 20  # its name in datasets of version 0.1.0
    # Objects of an action
    NOT_AFFORDED = "NOT_AFFORDED", 21
    NOT_SIMULATED = "NOT_SIMULATED", 22
    # A program as a whole
    NEAR_DUPLICATE = "NEAR_DUPLICATE", 23
    NO_EFFECT = "NO_EFFECT", 24
    OFF_TOPIC = "OFF_TOPIC", 25
    UNDECLARED = "UNDECLARED", 26
    # Place and posture of the character
    NOT_CLOSE = "NOT_CLOSE", 27
    NOT_FACING = "NOT_FACING", 28
    NOT_IN_ROOM = "NOT_IN_ROOM", 29
    NO_ROOM = "NO_ROOM", 30
    SITTING = "SITTING", 31
    LYING = "LYING", 32
    NOT_SITTING_OR_LYING = "NOT_SITTING_OR_LYING", 33
    DOOR_CLOSED = "DOOR_CLOSED", 34
    NO_PATH = "NO_PATH", 35
    # Hands
    NO_FREE_HAND = "NO_FREE_HAND", 36
    NOT_HOLDING = "NOT_HOLDING", 37
    NO_ORIGIN = "NO_ORIGIN", 38
    HELD_BY_OTHER = "HELD_BY_OTHER", 39
    HELD_ALREADY = "HELD_ALREADY", 82
    # The object's state
    OCCUPIED = "OCCUPIED", 40
    INSIDE_CLOSED = "INSIDE_CLOSED", 41
    IS_OPEN = "IS_OPEN", 42
    IS_CLOSED = "IS_CLOSED", 43
    IS_ON = "IS_ON", 44
    IS_OFF = "IS_OFF", 45
    IS_PLUGGED = "IS_PLUGGED", 46
    IS_UNPLUGGED = "IS_UNPLUGGED", 47
    NOT_OPENABLE_STATE = "NOT_OPENABLE_STATE", 48
    NOT_WORN = "NOT_WORN", 49
    NOTHING_TO_EAT = "NOTHING_TO_EAT", 50
    WRONG_STATE = "WRONG_STATE", 85
    # Several agents
    CONFLICT = "CONFLICT", 51
    UNKNOWN_AGENT = "UNKNOWN_AGENT", 52
    # Grounding
    UNBOUND = "UNBOUND", 53
    CONTRADICTION = "CONTRADICTION", 54
    NO_PLACE = "NO_PLACE", 55
    CONDITION_UNMET = "CONDITION_UNMET", 56
    # Augmenting
    NO_HANDLER = "NO_HANDLER", 57
    HANDLER_ERROR = "HANDLER_ERROR", 58
    TOO_MANY_TRIES = "TOO_MANY_TRIES", 59
    LOOP = "LOOP", 60
    GOAL_LOST = "GOAL_LOST", 61
    UNPERTURBED = "UNPERTURBED", 62
    CIRCUMSTANCES_LOST = "CIRCUMSTANCES_LOST", 73
    # Scoring and publishing
    UNKNOWN_ID = "UNKNOWN_ID", 63
    MISSING_PREDICTION = "MISSING_PREDICTION", 64
    REPLAY_DIFFERS = "REPLAY_DIFFERS", 65
    NOT_RENDERED = "NOT_RENDERED", 66
    # This machine, and Hearth itself
    FILE_TOO_LARGE = "FILE_TOO_LARGE", 67
    UNWRITABLE = "UNWRITABLE", 68
    LOCKED = "LOCKED", 69
    INTERNAL_ERROR = "INTERNAL_ERROR", 70
    DAMAGED_FILE = "DAMAGED_FILE", 71
    TIMED_OUT = "TIMED_OUT", 72
    BAD_ARGUMENT = "BAD_ARGUMENT", 74
    # Agents and their answers
    NOT_SEEN = "NOT_SEEN", 75
    NOT_ALLOWED = "NOT_ALLOWED", 76
    DISCONNECTED = "DISCONNECTED", 77
    AGENT_FAILED = "AGENT_FAILED", 78
    FINISHED = "FINISHED", 83
    NO_ANSWER = "NO_ANSWER", 86
    OVER_BUDGET = "OVER_BUDGET", 87
    # People and their browsers
    NO_SESSION = "NO_SESSION", 79
    TOO_FAST = "TOO_FAST", 80
    OUT_OF_ORDER = "OUT_OF_ORDER", 81


@dataclass(frozen=True, slots=True)
class Failure:
    """The reason why an instruction could not be done.

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
        at = f"tick {self.tick + 1}, [{self.action}] {what}".rstrip() if self.action else what
        facts = (("expected", self.expected), ("found", self.actual))
        known = ", ".join(f"{word} {fact}" for word, fact in facts if fact)
        return ": ".join(filter(None, (str(self.code), "; ".join(filter(None, (at, known))))))
