"""One sentence a failure: the reason why a step failed, and the remedy; the code stands at the end."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.spoken_words import fact_words, requirement_words, spoken
from hearth.schemas.syntax import print_step

MOST_NAMED = 4
"""Things that a sentence names."""


USED_UP = "used up"
"""The fact that an act found of a thing that is gone by action set 3: eaten, drunk, poured out or thrown away."""

NO_USUAL_PLACE = "a usual place"
"""The fact that NO_PLACE expects, for classes without placements."""


def sentence(failure: Failure, number: int = 0, step: str = "", remedy: str | None = "", code: bool = True) -> str:
    """Return a failure in words: `step 3 failed: [Open] <fridge> (1.5): the fridge is open; leave it out (IS_OPEN)`.

    Args:
        failure: of any code.
        number: of the step, from 1; 0 where the failure is about no step.
        step: as the program has it.
        remedy: what would fix it here; else what usually does. None: nothing is advised.
        code: whether the code stands at the end.
    """
    said = "; ".join(filter(None, (why(failure), "" if remedy is None else remedy or usual_remedy(failure))))
    begin = f"step {number} failed" if number else ""
    return ": ".join(filter(None, (begin, step, f"{said} ({failure.code})" if code else said)))


def in_program(failure: Failure, program: Program, remedy: str = "", code: bool = True) -> str:
    """Return a failure in words, with the step that it is about, if it is about one of the program."""
    number = step_number(program, failure) if failure.action else 0
    step = print_step(program.steps[number - 1]) if 0 < number <= len(program.steps) else ""
    return sentence(failure, number if step else 0, step, remedy, code)


def usual_remedy(failure: Failure) -> str:
    """Return what usually helps; "" where nothing does. Of a step that no earlier one prevents, what helps the step."""
    code = failure.code
    if failure.actual == USED_UP:
        return "use another"
    if code is Code.CONTRADICTION and " by no step" in failure.actual:
        code = Code.__members__.get(failure.expected.partition(":")[0], code)
    return REMEDIES.get(code, "")


def step_number(program: Program, failure: Failure) -> int:
    """Return the number, from 1, of the step that a failure is about: in its tick, that of its agent."""
    number = 1
    for tick, steps in enumerate(program.ticks()):
        if tick == failure.tick:
            mine = (place for place, step in enumerate(steps) if step.agent == failure.agent)
            return number + next(mine, 0)
        number += len(steps)
    return number


def why(failure: Failure) -> str:
    """Return why it failed, in words."""
    if failure.actual == USED_UP:
        return f"the {_names(failure)[0]} is used up"
    special = SPECIAL.get((failure.code, failure.expected)) or WHY[failure.code]
    if not isinstance(special, str):
        return special(failure)
    return special.format(*_names(failure), action=failure.action, expected=failure.expected, actual=failure.actual)


def meaning(code: Code) -> str:
    """Return what a code says of any thing: `the thing is inside the container, which is closed`."""
    return MEANINGS.get(code) or why(Failure(code, action="Action", names=("thing", "other thing")))


def listed(names: Sequence[str]) -> str:
    """Return some names in words: `the cup, the plate and 2 more things`."""
    shown = [f"the {spoken(name)}" for name in names[:MOST_NAMED]]
    rest = len(names) - len(shown)
    last = f"{rest} more thing{'s' * (rest > 1)}" if rest else shown.pop() if shown else "something"
    return f"{', '.join(shown)} and {last}" if shown else last


def _names(failure: Failure) -> tuple[str, str]:
    first, second, *_ = (*map(spoken, failure.names), "thing", "thing")
    return first, second


def _hands(failure: Failure) -> str:
    held = failure.names[1:]
    return f"both hands are full: they hold {listed(held)}" if held else "both hands are full"


def _seat(failure: Failure) -> str:
    seat, *others = failure.names or ("seat",)
    if failure.expected == "nobody on it":
        return f"somebody is on the {spoken(seat)}"
    return f"there is no room left on the {spoken(seat)}: {listed(others)} {'is' if len(others) == 1 else 'are'} on it"


def _wrong_state(failure: Failure) -> str:
    """Return the words for a thing that is already as the step would make it, with the act that would change that."""
    name, act = spoken(failure.names[0]) if failure.names else "thing", failure.expected.partition("([")[2]
    if not failure.actual or failure.actual == "not so":
        return f"the {name} is not in the state that this needs"
    undone = f": [{act.partition(']')[0]}] would change that" if act else ", which nothing undoes"
    return f"the {name} is {spoken(failure.actual.lower())}{undone}"


def _agent(failure: Failure) -> str:
    there = failure.actual.partition(" ")[0] or "0"
    return f"there is no character {failure.agent}: the home has {there}, counted from 0"


def _unbound(failure: Failure) -> str:
    name = spoken(failure.names[0]) if failure.names else "object"
    if failure.actual == "it has none":
        return f"the home has no {name}"
    if failure.actual == "no node":
        return f"the {name} is bound to nothing in the home"
    if failure.actual.endswith(", which the home lacks"):
        return f"the home has no node {failure.actual.partition(',')[0]} ({name})"
    return f"no {name} of the home can be used: {failure.actual}"


def _conflict(failure: Failure) -> str:
    code, _, rest = failure.actual.partition(" ")
    if not rest:
        return "the characters get in each other's way"
    known = Code.__members__.get(code)
    inner = why(Failure(known, 0, failure.agent, failure.action, failure.objects, failure.names)) if known else code
    return f"{inner}, after the other character's act in the same step"


def _not_afforded(failure: Failure) -> str:
    needed = requirement_words(failure.expected) or "another"
    return f"[{failure.action}] does not work with the {_names(failure)[0]}: its object must be {needed}"


def _contradiction(failure: Failure) -> str:
    """Return the words for a step that an earlier one makes impossible, or the start of any home."""
    code, _, _ = failure.expected.partition(":")
    known = Code.__members__.get(code)
    if known is None:
        return _facts("the program contradicts itself")(failure)
    inner = why(replace(failure, code=known, expected="", actual=""))
    _, by, step = failure.actual.rpartition("made impossible by ")
    return f"{inner} after {step}" if by else f"{inner}, and no start of the home makes that possible"


def _no_room(failure: Failure) -> str:
    if failure.expected.startswith("a home with"):
        return f"this takes {failure.expected}; {failure.actual}"
    return f"the {_names(failure)[0]} is in no room, so nobody can walk to it"


def _no_path(failure: Failure) -> str:
    if "floor ahead" in failure.expected:
        return f"the way ahead is blocked: it takes {failure.expected}, and there is {failure.actual}"
    return f"no way leads to the {_names(failure)[0]}"


def _no_place(failure: Failure) -> str:
    name = f"the {_names(failure)[0]}" if failure.names else "it"
    facts = f": it takes {failure.expected}, and this is {failure.actual}" if failure.expected else ""
    return f"there is no place for {name}{facts}"


def _facts(words: str) -> Callable[[Failure], str]:
    """Return a test for these words and, where the failure has them, the needed and the found fact."""

    def said(failure: Failure) -> str:
        known = (("needed", failure.expected), ("found", failure.actual))
        facts = ", ".join(f"{word} {fact_words(fact)}" for word, fact in known if fact)
        return f"{words}: {facts}" if facts else words

    return said


Words = str | Callable[[Failure], str]
"""A template of the names of two objects, `action`, `expected` and `actual`; or what makes the words."""

SPECIAL: Mapping[tuple[Code, str], Words] = {
    (Code.NOT_HOLDING, "a knife in a hand"): "the character holds no knife",
    (Code.NOT_HOLDING, "something in a hand"): "the character's hands are empty, and this is done with something",
    (Code.NOT_HOLDING, "the object in the left hand"): "the {0} is not in the left hand",
    (Code.NOT_HOLDING, "the object in the right hand"): "the {0} is not in the right hand",
    (Code.NO_FREE_HAND, "a free left hand"): "the left hand is full",
    (Code.NO_FREE_HAND, "a free right hand"): "the right hand is full",
    (Code.NOT_FACING, "the seat facing it"): "the seat does not face the {0}",
    (Code.NOT_AFFORDED, "two different things"): "the {0} is named twice, and this takes two different things",
    (Code.NO_PATH, "something with a place"): "nobody knows where the {0} stands",
    (
        Code.NO_PLACE,
        NO_USUAL_PLACE,
    ): "nobody knows where a {0} belongs: the home has none, and no place is usual for it",
    (Code.NO_PLACE, "a home with geometry"): "the home does not say where in the room things are",
    (Code.CONFLICT, "one instruction an agent and tick"): "one character is to do two things at the same time",
    (Code.NOT_SIMULATED, "a character at a place"): "the home does not say where the character stands",
    (Code.WRONG_STATE, "INSIDE(a, o)"): "the character is not in the {0}",
    (Code.WRONG_STATE, "not INSIDE(a, o)"): "the character is already in the {0}",
    (Code.UNBOUND, "a step"): "the program has no step",
    (Code.DUPLICATE, "a program of its own"): "{actual}",
    (Code.UNPERTURBED, "a program of its own"): "{actual}",
    (Code.UNPERTURBED, "a precondition that can be perturbed"): "it has no precondition that can be perturbed",
}
"""Words of a failure whose code is ambiguous, by the expected fact."""

WHY: Mapping[Code, Words] = {
    # Reading
    Code.EMPTY: "there is nothing in it",
    Code.NOT_TEXT: "it is not text",
    Code.LINE_TOO_LONG: "a line is too long",
    Code.BAD_ARCHIVE: "the archive cannot be opened",
    Code.BAD_JSON: "it is not valid JSON",
    Code.BAD_TABLE: "the table cannot be read",
    Code.BAD_GRAPH: "the scene graph cannot be used",
    Code.MISSING_FILE: "the file is missing",
    Code.UNSUPPORTED_FILE: "files of this kind cannot be read",
    Code.DUPLICATE: "the same record was read before",
    Code.REJECTED_ANSWER: "the answer was rejected when it was collected",
    # Syntax and names
    Code.SYNTAX: _facts("this could not be read as a step"),
    Code.BAD_INSTANCE: "the number of an object is not a number from 1",
    Code.UNKNOWN_ACTION: "there is no action [{action}]",
    Code.UNKNOWN_OBJECT: "there is no object class `{0}`",
    Code.UNKNOWN_HOME: "there is no home of that name",
    Code.WRONG_ARITY: "[{action}] takes {expected}, not {actual}",
    Code.SPECIAL_BLOCK: "this step is not among the actions",
    Code.NOT_UNDERSTOOD: "this could not be read as a step",
    Code.AMBIGUOUS: "this can be read in several ways",
    Code.FUZZY_MATCH: "this was read as something similar",
    Code.NO_STEP: "this line was left out: it is not numbered as the steps are",
    # Objects of an action
    Code.NOT_AFFORDED: _not_afforded,
    Code.NOT_SIMULATED: "[{action}] can be written, but the simulator does not execute it",
    # A program as a whole
    Code.NEAR_DUPLICATE: "it is nearly the same as another program",
    Code.NO_EFFECT: "it changes nothing",
    Code.OFF_TOPIC: "it does not fit its title",
    Code.UNDECLARED: "it does not say where it comes from",
    # Place and posture of the character
    Code.NOT_CLOSE: "the character is not near the {0}",
    Code.NOT_FACING: "the character does not face the {0}",
    Code.NOT_IN_ROOM: "the {0} is in another room",
    Code.NO_ROOM: _no_room,
    Code.SITTING: "the character is sitting",
    Code.LYING: "the character is lying down",
    Code.NOT_SITTING_OR_LYING: "the character is standing",
    Code.DOOR_CLOSED: "a closed {0} is in the way to the {1}",
    Code.NO_PATH: _no_path,
    # Hands
    Code.NO_FREE_HAND: _hands,
    Code.NOT_HOLDING: "the character does not hold the {0}",
    Code.NO_ORIGIN: "the {0} was not taken from anywhere, so it cannot be put back",
    Code.HELD_BY_OTHER: "another character holds the {0}",
    Code.HELD_ALREADY: "the {0} is already in a hand",
    # The object's state
    Code.OCCUPIED: _seat,
    Code.INSIDE_CLOSED: "the {0} is inside the {1}, which is closed",
    Code.IS_OPEN: "the {0} is open",
    Code.IS_CLOSED: "the {0} is closed",
    Code.IS_ON: "the {0} is on",
    Code.IS_OFF: "the {0} is off",
    Code.IS_PLUGGED: "the {0} is plugged in",
    Code.IS_UNPLUGGED: "the {0} is unplugged",
    Code.NOT_OPENABLE_STATE: "the {0} is neither open nor closed",
    Code.NOT_WORN: "the character does not wear the {0}",
    Code.NOTHING_TO_EAT: "the {0} is not food, and there is no food on it",
    Code.WRONG_STATE: _wrong_state,
    # Several agents
    Code.CONFLICT: _conflict,
    Code.UNKNOWN_AGENT: _agent,
    # Grounding
    Code.UNBOUND: _unbound,
    Code.CONTRADICTION: _contradiction,
    Code.NO_PLACE: _no_place,
    Code.CONDITION_UNMET: _facts("no home could be made in which a condition holds"),
    # Augmenting
    Code.NO_HANDLER: _facts("there is no repair for this"),
    Code.HANDLER_ERROR: _facts("the repair itself failed"),
    Code.TOO_MANY_TRIES: _facts("too many repairs would be needed"),
    Code.LOOP: _facts("the repairs lead back to an earlier program"),
    Code.GOAL_LOST: _facts("the repaired program does not reach what the original reached"),
    Code.UNPERTURBED: _facts("no variant of it was made"),
    Code.CIRCUMSTANCES_LOST: _facts("the repaired program does a step in other circumstances"),
    # Scoring and publishing
    Code.UNKNOWN_ID: "there is nothing with that id",
    Code.MISSING_PREDICTION: "there is no prediction for it",
    Code.REPLAY_DIFFERS: _facts("running it again gives something else"),
    Code.NOT_RENDERED: _facts("it could not be pictured"),
    # This machine, and Hearth itself
    Code.FILE_TOO_LARGE: "the file is too large",
    Code.UNWRITABLE: "it cannot be written there",
    Code.LOCKED: "another command is writing there",
    Code.INTERNAL_ERROR: _facts("Hearth itself failed"),
    Code.DAMAGED_FILE: "the file is damaged",
    Code.TIMED_OUT: "it took longer than the time limit",
    Code.BAD_ARGUMENT: _facts("an argument is not of its type"),
    # Agents and their answers
    Code.NOT_SEEN: "the character does not see the {0}",
    Code.NOT_ALLOWED: "[{action}] is not allowed here",
    Code.DISCONNECTED: "the agent is gone",
    Code.AGENT_FAILED: _facts("the agent failed"),
    Code.NO_ANSWER: _facts("the language model gave no answer that can be used"),
    Code.OVER_BUDGET: _facts("the budget for the language model is spent"),
    # People and their browsers
    Code.NO_SESSION: "there is no session",
    Code.TOO_FAST: "this came too soon after the last",
    Code.OUT_OF_ORDER: "this came out of order",
    Code.FINISHED: "the person ended it",
}
"""Reasons of failures, in words, for every code."""

MEANINGS: Mapping[Code, str] = {
    Code.WRONG_ARITY: "the action takes another number of objects",
    Code.UNKNOWN_ACTION: "there is no action of that name",
    Code.UNKNOWN_OBJECT: "there is no object class of that name",
    Code.NOT_AFFORDED: "the action does not work with an object of this kind",
    Code.NOT_SIMULATED: "the action can be written, but the simulator does not execute it",
    Code.NOT_ALLOWED: "the action is not allowed here",
    Code.UNKNOWN_AGENT: "the home has no character of that number",
    Code.UNBOUND: "the home has no such thing, or none that the program can use",
    Code.NO_FREE_HAND: "both hands are full",
    Code.OCCUPIED: "there is no room left on the seat",
    Code.WRONG_STATE: "the thing is not in the state that the action needs",
    Code.NO_PLACE: "there is no place for the thing",
}
"""Words for a code alone, where those of a failure need its facts."""

REMEDIES: Mapping[Code, str] = {
    Code.UNBOUND: "use another object or home",
    Code.NOT_AFFORDED: "use another object or action",
    Code.NOT_SIMULATED: "use an action that is executed",
    Code.UNKNOWN_ACTION: "use an action of the grammar",
    Code.UNKNOWN_AGENT: "use one of the characters, or a home with more",
    Code.WRONG_ARITY: "name as many objects as it takes",
    Code.NO_PATH: "go another way",
    Code.NO_ROOM: "use a home with such a room, or put the thing into one",
    Code.NO_PLACE: "use another place",
    Code.CONTRADICTION: "leave one of these steps out",
    Code.CONDITION_UNMET: "use another home",
    Code.HELD_ALREADY: "leave this step out",
    Code.NOT_CLOSE: "walk to it first",
    Code.NOT_HOLDING: "take it first",
    Code.NO_FREE_HAND: "put something down first",
    Code.NOT_FACING: "turn to it first",
    Code.OCCUPIED: "take things off it first",
}
"""Remedies of a failure for a person, where no repair is known, or the repairs find nothing in this home."""
