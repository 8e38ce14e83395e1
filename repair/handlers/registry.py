"""Handlers by failure code. To add one: a function, a row here, a test, its words in kb/data/repairs.yaml."""

from hearth.repair.handlers import agents, appliances, food, goals, hands, locomotion, posture, restored_states, senses
from hearth.repair.handlers.common import Handler, leaving_out
from hearth.schemas.failures import Code

HANDLERS: dict[Code, Handler] = {
    Code.CIRCUMSTANCES_LOST: goals.circumstances_lost,
    Code.CONFLICT: agents.conflict,
    Code.DOOR_CLOSED: locomotion.door_closed,
    Code.GOAL_LOST: goals.goal_lost,
    Code.HELD_BY_OTHER: agents.held_by_other,
    Code.INSIDE_CLOSED: appliances.inside_closed,
    Code.IS_CLOSED: appliances.is_closed,
    Code.IS_OFF: appliances.is_off,
    Code.IS_ON: appliances.is_on,
    Code.IS_OPEN: leaving_out("already_open"),
    Code.IS_PLUGGED: leaving_out("already_plugged"),
    Code.IS_UNPLUGGED: appliances.is_unplugged,
    Code.LYING: posture.lying,
    Code.NOTHING_TO_EAT: food.nothing_to_eat,
    Code.NOT_CLOSE: locomotion.not_close,
    Code.NOT_FACING: senses.not_facing,
    Code.NOT_HOLDING: hands.not_holding,
    Code.NOT_IN_ROOM: locomotion.not_in_room,
    Code.NOT_OPENABLE_STATE: leaving_out("neither_open_nor_closed"),
    Code.NOT_SITTING_OR_LYING: posture.not_resting,
    Code.NOT_WORN: leaving_out("not_worn"),
    Code.NO_FREE_HAND: hands.no_free_hand,
    Code.NO_ORIGIN: hands.no_origin,
    Code.OCCUPIED: posture.occupied,
    Code.SITTING: posture.sitting,
    Code.WRONG_STATE: restored_states.wrong_state,
}
"""Handlers by failure code: those of table A.4, and those that it leaves out."""

UNREPAIRABLE: dict[Code, str] = {
    Code.NOT_AFFORDED: "no earlier act makes an object fit for this use",
    Code.NOT_SIMULATED: "the action is never executed",
    Code.NO_PATH: "no door leads there, open or closed",
    Code.NO_ROOM: "the object is in no room, so nobody can go to it",
    Code.UNBOUND: "the object is not a node of this home",
    Code.UNKNOWN_ACTION: "no action has that name",
    Code.UNKNOWN_AGENT: "the home has fewer characters than the program",
}
"""Failures of running a program for which there is no repair, and why."""

BEFORE_REPAIR: frozenset[Code] = frozenset(
    {
        Code.EMPTY, Code.NOT_TEXT, Code.LINE_TOO_LONG, Code.BAD_ARCHIVE, Code.BAD_JSON, Code.BAD_TABLE, Code.BAD_GRAPH,
        Code.MISSING_FILE, Code.UNSUPPORTED_FILE, Code.DUPLICATE, Code.REJECTED_ANSWER, Code.SYNTAX, Code.BAD_INSTANCE,
        Code.UNKNOWN_OBJECT, Code.UNKNOWN_HOME, Code.WRONG_ARITY, Code.SPECIAL_BLOCK, Code.CONTRADICTION, Code.NO_PLACE,
        Code.CONDITION_UNMET, Code.NO_HANDLER, Code.HANDLER_ERROR, Code.TOO_MANY_TRIES, Code.LOOP, Code.UNPERTURBED,
        Code.UNKNOWN_ID, Code.MISSING_PREDICTION, Code.REPLAY_DIFFERS, Code.NOT_RENDERED,
        Code.NEAR_DUPLICATE, Code.NO_EFFECT, Code.OFF_TOPIC, Code.UNDECLARED,
        Code.NOT_UNDERSTOOD, Code.AMBIGUOUS, Code.FUZZY_MATCH, Code.NO_STEP, Code.DAMAGED_FILE,
        Code.FILE_TOO_LARGE, Code.UNWRITABLE, Code.LOCKED, Code.INTERNAL_ERROR, Code.TIMED_OUT,
        Code.BAD_ARGUMENT, Code.HELD_ALREADY, Code.NOT_SEEN, Code.NOT_ALLOWED, Code.DISCONNECTED, Code.AGENT_FAILED,
        Code.NO_SESSION, Code.TOO_FAST, Code.OUT_OF_ORDER, Code.FINISHED, Code.NO_ANSWER,
        Code.OVER_BUDGET,
    }
)  # fmt: skip
"""Codes of reading, checking, grounding, repairing itself, scoring, publishing and agents: no run ends in them, but for
HELD_ALREADY in challenges, where nothing is repaired."""


def unclassified() -> tuple[Code, ...]:
    """Codes that stand in none of the three tables, or in two of them."""
    tables = (HANDLERS, UNREPAIRABLE, BEFORE_REPAIR)
    return tuple(code for code in Code if sum(code in table for table in tables) != 1)


if unclassified():
    raise AssertionError(f"add a handler or a reason for {', '.join(unclassified())}: repair/handlers/registry.py")
