"""ALFWorld's commands: `go to fridge 1`, `take apple 1 from countertop 1`, `> open fridge 1`."""

import re
from collections.abc import Callable, Collection, Sequence
from itertools import pairwise

from hearth.kb.language.forms.form import Form, Placed, step, title
from hearth.kb.language.refusals import Refusal
from hearth.kb.language.steps_from_calls import written

_THING = r"([a-z]+(?: [a-z]+){0,2} \d{1,3})"
_COMMANDS: dict[str, tuple[str, ...]] = {
    rf"go to {_THING}": ("Walk", "0"),
    rf"open {_THING}": ("Open", "0"),
    rf"close {_THING}": ("Close", "0"),
    rf"(?:use|toggle) {_THING}": ("SwitchOn", "0"),
    rf"examine {_THING}(?: with {_THING})?": ("LookAt", "0"),
    rf"take {_THING} from {_THING}": ("Grab", "0"),
    rf"(?:put|move) {_THING} (in) {_THING}": ("PutIn", "0", "2"),
    rf"(?:put|move) {_THING} (in/on|on|to) {_THING}": ("PutBack", "0", "2"),
    rf"clean {_THING} with {_THING}": ("Wash", "0"),
    rf"heat {_THING} with {_THING}": ("Heat", "0", "1"),
    rf"cool {_THING} with {_THING}": ("Cool", "0", "1"),
}
"""A command -> the action, and which of its words are the objects."""

_READ = [(re.compile(rf"(?:> ?)?{words}\.?", re.IGNORECASE), meant) for words, meant in _COMMANDS.items()]
_NO_STEP = re.compile(r"(?:> ?)?(?:look|inventory|think: .*)\.?", re.IGNORECASE)
_HOLLOW = frozenset(
    [
        "fridge",
        "cabinet",
        "drawer",
        "microwave",
        "safe",
        "garbagecan",
        "box",
        "bathtubbasin",
        "sinkbasin",
        "washingmachine",
    ]
)
"""Things into which `put in/on` puts, as on others it does not."""

_NAMES = {
    "countertop": "kitchen counter",
    "sinkbasin": "sink",
    "bathtubbasin": "bathtub",
    "stoveburner": "stove",
    "sidetable": "table",
}
"""ALFWorld's names of classes that have another name here."""

NOTHING = re.compile(r"\s*(?:(?:obs|observation)\s*\d*\s*:)?\s*nothing happens\.?\s*", re.IGNORECASE)
"""The game's answer to a command that changed nothing."""

_NO_EFFECT = Refusal(
    "the game answered that nothing happens; the step is kept", "leave it out if it is not meant", is_warning=True
)

_RULED = re.compile(r"\s*={2,}\s*([^=]+?)\s*={2,}\s*")
_OTHERS = re.compile(r"\s*(?:\d+[.)]|[-*•]|\[?step \d+\]?:?)\s+", re.IGNORECASE)


def command(words: str) -> str:
    """Return the step of a command, in the syntax of programs; empty for words that are none."""
    text = " ".join(words.split())
    for pattern, (action, *at) in _READ:
        found = pattern.fullmatch(text)
        if found:
            things = [_named(found[int(place) + 1]) for place in at]
            hollow = action == "PutBack" and found[2] == "in/on" and found[3].rpartition(" ")[0].lower() in _HOLLOW
            return written("PutIn" if hollow else action, things)
    return ""


def _named(thing: str) -> str:
    name, _, number = thing.lower().rpartition(" ")
    return f"{_NAMES.get(name, name)} {number}"


def _words(raw: str) -> str:
    return _OTHERS.sub("", raw.strip()[:300], count=1).strip()


def _fits(lines: Sequence[str]) -> bool:
    """Return whether a third of the lines, and two at least, are commands, or `>` stands before one."""
    texts = [line for line in lines if line.strip()]
    found = [line for line in texts if command(_words(line))]
    return (len(found) > 1 and 3 * len(found) >= len(texts)) or any(line.lstrip().startswith(">") for line in found)


def _lines(lines: Sequence[str]) -> list[Placed]:
    """Return the commands; once a line begins with `>`, the others are what the game answered."""
    is_log = any(line.lstrip().startswith(">") for line in lines)
    without_effect = rows_without_effect(lines) if is_log else frozenset()
    return read(lines, lambda raw: raw if raw.lstrip().startswith(">") or not is_log else "", without_effect)


def doubted(placed: Placed) -> Placed:
    """Return a step with the warning that the game answered that nothing happens."""
    return placed._replace(line=placed.line._replace(why=_NO_EFFECT))


def rows_without_effect(lines: Sequence[str]) -> frozenset[int]:
    """Return the rows of commands that the game answers with "Nothing happens"."""
    said = [row for row, line in enumerate(lines) if line.strip()]
    return frozenset(row for row, after in pairwise(said) if NOTHING.fullmatch(lines[after]))


def read(lines: Sequence[str], words_of: Callable[[str], str], without_effect: Collection[int] = ()) -> list[Placed]:
    """Return the steps of the lines of which `words_of` gives words; title and description stand above the first.

    Commands without an effect are steps, with a warning.
    """
    from hearth.kb.language.plan_lines import plan_line

    found: list[Placed] = []
    begun = False
    for row, raw in enumerate(lines):
        words = _words(words_of(raw))
        if words and (meant := command(words)):
            begun = True
            found.append(doubted(step(row, meant)) if row in without_effect else step(row, meant))
        elif ruled := _RULED.fullmatch(raw[:200]):
            found.append(title(row, ruled[1]))
        elif words and begun and not _NO_STEP.fullmatch(words):
            found.append(step(row, words.removeprefix(">")))
        elif not begun and not raw.lstrip().startswith(">"):
            found.append(Placed(row, plan_line(raw)._replace(number=None, numbered=False)))
    return found


COMMANDS = Form(
    _fits,
    _lines,
    lambda raw: bool(command(_words(raw))),
    re.compile(r"\s*(task\b|={2,}\s*\w[^=]*={2,}|your task is to:)", re.IGNORECASE),
)
