"""SyntheticPrograms: programs drawn from a probabilistic grammar, each with several descriptions (thesis 4.4)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate, groupby
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from hearth.analysis.synthesis_wording import (
    HELD_OUT,
    TYPO,
    Speaker,
    Wording,
    load_words,
    mistyped,
    paraphrase,
    slots_of,
)
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.rng import rng
from hearth.storage.input_files import load_yaml

DEFAULT_COUNT = 5_193
"""Number of programs in the thesis's SyntheticPrograms (table 4.1)."""

FILE = Path(__file__).parent / "synthesis.yaml"

LARGEST_WEIGHT = 1e12
"""Largest sum of weights in a grammar."""

_TRIES = 60
_DRAWS = 10_000
"""Tasks that are drawn for a program, at most: where fewer differ than it wants, it has these."""

_HANDS = 2


@dataclass(frozen=True, slots=True)
class Weighted:
    """A weighted distribution over names.

    Attributes:
        things: the names.
        sums: of their weights up to each.
        likeliest: the name with the greatest weight; of several the first.
    """

    things: tuple[str, ...]
    sums: tuple[float, ...]
    likeliest: str

    @classmethod
    def of(cls, weights: Mapping[Any, float]) -> Weighted:
        """Return the entries of a mapping with positive weight.

        Raises:
            ValueError: there are none, or weights that are not numbers of any use.
        """
        kept = {str(thing): weight for thing, weight in weights.items() if weight > 0}
        if not kept or not sum(kept.values()) < LARGEST_WEIGHT:
            raise ValueError(f"weights {str(weights)[:60]}")
        return cls(tuple(kept), tuple(accumulate(kept.values())), max(kept, key=lambda name: kept[name]))

    def draw(self, chance: Random) -> str:
        """Return a random name."""
        return chance.choices(self.things, cum_weights=self.sums)[0]


@dataclass(frozen=True, slots=True)
class Part:
    """Steps that are described together.

    Attributes:
        steps: `(action, slots)`.
        say: paraphrases of their description.
        chance: probability that a program has them.
        described: probability that a description mentions them.
    """

    steps: tuple[tuple[str, tuple[str, ...]], ...]
    say: tuple[str, ...]
    chance: float
    described: float


@dataclass(frozen=True, slots=True)
class Task:
    """An activity: titles, distributions of objects by slot, parts, and its aims."""

    name: str
    titles: tuple[str, ...]
    slots: Mapping[str, Weighted]
    parts: tuple[Part, ...]
    aims: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Grammar:
    """The probabilistic grammar of programs."""

    plan: Weighted
    weights: Weighted
    tasks: Mapping[str, Task]
    join: float
    first: float
    known: Knowledge
    words: Wording


class ChosenPart(NamedTuple):
    """A part of a task that was drawn, and objects by slot: all of the task, or those that a clause names."""

    task: str
    part: Part
    chosen: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class Synthetic:
    """A synthetic program: title, steps as (action, objects), distinct descriptions, and its tasks.

    Of each description `held_out` says whether it uses the paraphrases that are held out, `mentioned` which parts it
    mentions.
    """

    title: str
    steps: tuple[tuple[str, tuple[str, ...]], ...]
    descriptions: tuple[str, ...]
    tasks: tuple[str, ...] = ()
    held_out: tuple[bool, ...] = ()
    mentioned: tuple[tuple[ChosenPart, ...], ...] = ()

    def lines(self) -> list[str]:
        """Return the steps as text."""
        return [" ".join([f"[{action}]", *(f"<{name}> (1)" for name in names)]) for action, names in self.steps]


def load(path: Path, known: Knowledge, every_action: bool = False) -> Grammar:
    """Read a grammar.

    Args:
        path: a YAML file in the format of `synthesis.yaml`; the former key `told` is read as `described`.
        known: actions and objects.
        every_action: keep parts with actions that are not animated (thesis 4.4).

    Raises:
        HearthError: every unknown action, object or slot, wrong number of objects, and missing affordance.
    """
    data = load_yaml(path)
    try:
        described = float(data["described"] if "described" in data else data["told"])
        entries = {name: _inherited(entry, data["tasks"]) for name, entry in data["tasks"].items()}
        tasks = {name: _task(name, entry, described) for name, entry in entries.items()}
        weights = {name: float(entry["weight"]) for name, entry in entries.items()}
        plan = Weighted.of(data["plan"])
        if any(int(number) < 1 for number in plan.things):
            raise ValueError("a plan of programs without tasks")
        join, first = float(data["join"]), float(data["first"])
    except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError) as error:
        message = f"not a grammar of programs: {type(error).__name__} {str(error)[:200]}"
        suggestion = "it needs plan, join, first, described and tasks"
        raise HearthError.of(Code.BAD_TABLE, message, file=str(path), suggestion=suggestion) from error
    words = load_words(known)
    faults = [fault for task in tasks.values() for fault in _faults(task, known, words, str(path))]
    if faults:
        raise HearthError(faults)
    kept = {name: task if every_action else _animated(task, known) for name, task in tasks.items()}
    try:
        drawn = Weighted.of({name: weights[name] for name, task in kept.items() if task.parts})
    except ValueError as error:
        raise HearthError.of(Code.EMPTY, f"no task can be drawn: {error}", file=str(path)) from error
    return Grammar(plan, drawn, kept, join, first, known, words)


def _inherited(entry: Mapping[str, Any], entries: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a task's entry, with its missing parts from the task that it is like."""
    return {**entries[entry["like"]], "aims": (), **entry} if "like" in entry else entry


def _task(name: str, entry: Mapping[str, Any], described: float) -> Task:
    slots = {slot: Weighted.of(weights) for slot, weights in entry["choose"].items()}
    parts = tuple(
        Part(
            tuple((words[0], tuple(words[1:])) for words in map(str.split, part["steps"])),
            tuple(part["say"]),
            float(part.get("chance", 1)),
            float(part.get("described", part.get("told", described))),
        )
        for part in entry["parts"]
    )
    return Task(name, tuple(entry["titles"]), slots, parts, tuple(map(str, entry.get("aims", ()))))


def _animated(task: Task, known: Knowledge) -> Task:
    animated = known.group("animated")
    parts = tuple(part for part in task.parts if all(action in animated for action, _ in part.steps))
    return Task(task.name, task.titles, task.slots, parts, task.aims)


def _faults(task: Task, known: Knowledge, words: Wording, file: str) -> Iterator[Diagnostic]:
    said = [*task.titles, *task.aims, *(text for part in task.parts for text in part.say)]
    if not task.titles or not all(part.steps and part.say for part in task.parts):
        yield Diagnostic(Code.BAD_TABLE, f"task `{task.name}`: no titles, or a part without steps or words", file)
    for text in said:
        if why := words.fault(text, task.slots):
            yield Diagnostic(Code.BAD_TABLE, f"task `{task.name}`: `{str(text)[:80]}` {why}", file)
    for part in task.parts:
        for action, slots in part.steps:
            found = known.actions.get(action)
            if found is None or found.arity != len(slots):
                code = Code.UNKNOWN_ACTION if found is None else Code.WRONG_ARITY
                yield Diagnostic(code, f"task `{task.name}`: [{action}] of {len(slots)} objects", file, found=action)
                continue
            for place, slot in enumerate(slots):
                for name in task.slots[slot].things if slot in task.slots else (slot,):
                    if known.object_class(name) is None:
                        message = f"task `{task.name}`: unknown object `{name}`"
                        yield Diagnostic(Code.UNKNOWN_OBJECT, message, file, found=name)
                    elif not known.affords(action, place, name):
                        message = f"task `{task.name}`: [{action}] can't be done to `{name}`"
                        yield Diagnostic(Code.NOT_AFFORDED, message, file, found=name)


def synthesize(count: int, seed: int, grammar: Grammar, descriptions: int = 2) -> Iterator[Synthetic]:
    """Yield distinct programs, the same for the same seed; a larger count begins with a smaller one's.

    Args:
        count: number of programs.
        seed: of all draws.
        grammar: the grammar.
        descriptions: greatest number of descriptions per program.

    Raises:
        HearthError: EMPTY, if the grammar has fewer than `count` different programs.
    """
    seen: set[tuple[tuple[str, tuple[str, ...]], ...]] = set()
    drawn = 0
    while len(seen) < count:
        if drawn >= _TRIES * count + 1_000:
            message = f"the grammar gave {len(seen):,} different programs, not {count:,}"
            raise HearthError.of(Code.EMPTY, message, suggestion="ask for fewer, or give it more tasks and objects")
        chance = rng(seed, "synthesize", drawn)
        drawn += 1
        found = _draw(grammar, chance, descriptions)
        if found is not None and found.steps not in seen:
            seen.add(found.steps)
            yield found


def _draw(grammar: Grammar, chance: Random, descriptions: int) -> Synthetic | None:
    """Return a program, or None if it is not executable: a third object to hold, a lamp switched on twice."""
    wanted = int(grammar.plan.draw(chance))
    names: list[str] = []
    for _ in range(_DRAWS):
        if len(names) >= min(wanted, len(grammar.weights.things)):
            break
        name = grammar.weights.draw(chance)
        if name not in names:
            names.append(name)
    parts: list[ChosenPart] = []
    for name in names:
        task = grammar.tasks[name]
        chosen = {slot: weighted.draw(chance) for slot, weighted in task.slots.items()}
        drawn = (part for part in task.parts if part.chance >= 1 or chance.random() < part.chance)
        parts += [ChosenPart(name, part, chosen) for part in drawn]
    steps = _steps(parts, grammar.known)
    if not steps:
        return None
    aims = [aim for name in names for aim in grammar.tasks[name].aims]
    ways: dict[str, tuple[bool, tuple[ChosenPart, ...]]] = {}
    for _ in range(descriptions):
        held_out = chance.random() < 1 / HELD_OUT
        text, mentioned = _describe(parts, aims, grammar, held_out, chance)
        ways.setdefault(text, (held_out, mentioned))
    title = chance.choice(grammar.tasks[names[0]].titles)
    held = tuple(each for each, _ in ways.values())
    return Synthetic(title, tuple(steps), tuple(ways), tuple(names), held, tuple(each for _, each in ways.values()))


def joined(parts: Iterable[ChosenPart], known: Knowledge) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the steps of some parts with their objects, and standing up before one walks away."""
    seated = False
    for _, part, chosen in parts:
        for action, slots in part.steps:
            if seated and action in known.group("goes"):
                yield "StandUp", ()
                seated = False
            yield action, tuple(chosen.get(slot, slot) for slot in slots)
            seated = action == "Sit" or (seated and action != "StandUp")


def _steps(parts: Sequence[ChosenPart], known: Knowledge) -> list[tuple[str, tuple[str, ...]]]:
    """Return the steps of the parts, none twice in a row; empty if they contradict each other or hands are full."""
    made: dict[tuple[str, str], str] = {}
    held: set[str] = set()
    seated = False
    steps = list(joined(parts, known))
    for action, names in steps:
        if not _possible(action, names, made, held, known) or (action == "StandUp" and not seated):
            return []
        seated = action == "Sit" or (seated and action != "StandUp")
    return [step for step, _ in groupby(steps)]


def _possible(
    action: str, names: tuple[str, ...], made: dict[tuple[str, str], str], held: set[str], known: Knowledge
) -> bool:
    """Return whether a step can follow the others; records its effect on objects and hands."""
    state = known.state_of(action) if action in known.group("operates") & known.group("animated") else ""
    if (action == "Grab" or state in ("OPEN", "ON", "OFF")) and len(held) >= _HANDS:
        return False
    if state:
        key = (known.group_of(state), names[0])
        if made.get(key) == state or (state == "OPEN" and made.get((known.group_of("ON"), names[0])) == "ON"):
            return False
        made[key] = state
    if action == "Sit":
        # A character that stood up still counts as ON its seat, which is then full.
        again = ("seat", names[0]) in made
        made["seat", names[0]] = action
        return not again
    if action == "Grab":
        where = made.pop(("place", names[0]), None)
        if names[0] in held or (where is not None and made.get((known.group_of("CLOSED"), where)) == "CLOSED"):
            return False
        held.add(names[0])
    elif action in known.group("puts"):
        held.discard(names[0])
        made["place", names[0]] = names[1]
        return names[0] != names[1]
    return True


def _describe(
    parts: Sequence[ChosenPart], aims: Sequence[str], grammar: Grammar, held_out: bool, chance: Random
) -> tuple[str, tuple[ChosenPart, ...]]:
    """Return a description of the parts, and those that it mentions; commonsense ones may be omitted (thesis 3.3)."""
    speaker = Speaker(grammar.words, chance.random() < grammar.first, chance)
    said = [each for each in parts if chance.random() < each.part.described] or list(parts[:1])
    clauses, mentioned = [], []
    for task, part, chosen in said:
        template, subject = paraphrase(part.say, held_out, chance), next(iter(part.steps[-1][1]), "")
        clauses.append(speaker.clause(template, chosen, subject))
        mentioned.append(ChosenPart(task, part, {slot: chosen[slot] for slot in slots_of(template, subject, chosen)}))
    text = " ".join(speaker.sentences(clauses, aims or grammar.words.aims, grammar.join))
    return mistyped(text, chance) if chance.random() < TYPO else text, tuple(mentioned)


def record(found: Synthetic, number: int, seed: int, splits: Mapping[str, str | None]) -> dict[str, Any]:
    """Return a program as a line of JSON Lines that `ingest` reads, labelled as generated, with its parts in splits."""
    return {
        "program_id": f"synthetic:{seed}:{number}",
        "origin": "synthetic",
        "title": found.title,
        "description": found.descriptions[0],
        "descriptions": list(found.descriptions[1:]),
        "steps": found.lines(),
        "tasks": list(found.tasks),
        "splits": dict(splits),
    }
