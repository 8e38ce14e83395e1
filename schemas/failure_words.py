"""One sentence a failure: the reason why a step failed, and the remedy; the code stands at the end."""

from collections.abc import Callable, Mapping, Sequence

from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Program
from hearth.schemas.yaml_limits import packaged

MOST_NAMED = 4
"""Things that a sentence names."""


def sentence(failure: Failure, number: int = 0, step: str = "", remedy: str = "") -> str:
    """Return a failure in words: `step 3 failed: [Open] <fridge> (1.5): the fridge is open; leave it out (IS_OPEN)`.

    Args:
        failure: of any code.
        number: of the step, from 1; 0 where the failure is about no step.
        step: as the program has it.
        remedy: what would fix it here; else what usually does.
    """
    said = "; ".join(filter(None, (why(failure), remedy or REMEDIES.get(failure.code, ""))))
    begin = f"step {number} failed" if number else ""
    return ": ".join(filter(None, (begin, step, f"{said} ({failure.code})")))


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


def spoken(name: str) -> str:
    """Return a class as people say it: `coffee maker`."""
    return name.replace("_", " ")


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
        facts = ", ".join(f"{word} {fact}" for word, fact in known if fact)
        return f"{words}: {facts}" if facts else words

    return said


Words = str | Callable[[Failure], str]
"""A template of the names of two objects, `action`, `expected` and `actual`; or what makes the words."""

_MADE: Mapping[str, Callable[[Failure], str]] = {
    "NO_ROOM": _no_room,
    "NO_PATH": _no_path,
    "NO_FREE_HAND": _hands,
    "OCCUPIED": _seat,
    "WRONG_STATE": _wrong_state,
    "CONFLICT": _conflict,
    "UNKNOWN_AGENT": _agent,
    "UNBOUND": _unbound,
    "NO_PLACE": _no_place,
}
_FILE = packaged("hearth.schemas", "failure_words.yaml")

SPECIAL: Mapping[tuple[Code, str], Words] = {
    (Code[code], expected): words for code, facts in _FILE["special"].items() for expected, words in facts.items()
}
"""Words of a failure whose code is ambiguous, by the expected fact."""

WHY: Mapping[Code, Words] = {
    Code[code]: _facts(words["facts"]) if isinstance(words, dict) else words
    for code, words in {**_FILE["why"], **_MADE}.items()
}
"""Reasons of failures, in words, for every code."""

MEANINGS: Mapping[Code, str] = {Code[code]: words for code, words in _FILE["meanings"].items()}
"""Words for a code alone, where those of a failure need its facts."""

REMEDIES: Mapping[Code, str] = {Code[code]: words for code, words in _FILE["remedies"].items()}
"""Remedies of a failure for a person, where no repair is known, or the repairs find nothing in this home."""
