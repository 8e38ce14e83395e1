"""The gist of a program: the steps that are the activity, not due to the environment (thesis 5.5.1).

A sketch keeps the steps that any environment would ask for. The functions here need no run: the effects meant by a
program, the actions never meant themselves, and the steps that the description names.
"""

import re
from collections.abc import Mapping
from functools import lru_cache

from hearth.grounding.preconditions.conditions import Preconditions
from hearth.grounding.preconditions.postconditions import Postconditions, facts, nodes_of
from hearth.kb.knowledge import Knowledge
from hearth.schemas.literals import HOLDS, Key, Literal
from hearth.schemas.program import Program, Step
from hearth.schemas.vocabulary import CHARACTER_CLASS
from hearth.simulation.engine import Execution
from hearth.simulation.world.world import World

_ANYTHING = frozenset({"thing", "artefact", "being"})
"""Kinds too general to be asked for by name."""

_INSERTED = ("preparation", "unsaid", "takes", "frees_hand", "rests", "operates", "dresses")


def replaceable(knowledge: Knowledge) -> frozenset[str]:
    """Actions that repairs insert by themselves, or that leave the world as it was; every other is the activity."""
    return frozenset().union(*map(knowledge.group, _INSERTED))


def meant(goal: Postconditions, program: Program, conditions: Preconditions, knowledge: Knowledge) -> Postconditions:
    """Return the effects that a program is for, without those that are by the way.

    Side effects are: the room where the character or a thing ends up; a container left open that was opened to take
    something out; a tool still in the hand, since its user has to hold it; and the content of a vessel after pouring,
    since pouring is a step that is kept anyway.
    """
    reached_into = {c.objects[1]: c.objects[0] for c in conditions if c.name in ("in", "inside")}
    preparation = knowledge.group("preparation")
    poured = {tuple(ref.key for ref in step.objects) for step in program.steps if step.action == "Pour"}

    def is_meant(fact: Literal[Key]) -> bool:
        name, subject, target = fact.name, fact.subject, fact.target
        if name == "INSIDE" and target is not None:
            return (
                not knowledge.is_room(target[0]) and subject[0] != CHARACTER_CLASS and (subject, target) not in poured
            )
        if name == "OPEN":
            return subject not in reached_into and not _used_after(program, "Open", subject, preparation)
        if name == HOLDS and target is not None:
            return not _used_after(program, "Grab", target, preparation) and not _is_tool(program, target, knowledge)
        return True

    return tuple(fact for fact in goal if is_meant(fact))


def milestones(execution: Execution) -> Postconditions:
    """Effects that were undone again, but not before something was done meanwhile: the stove that was on while cooking.

    Only devices switched on, objects put somewhere and where one sat or lay count; objects are held or opened for
    another step's sake. A device that switches itself off in time counts while it is on at the end: no repair
    can be asked to keep it so.
    """
    program, worlds = execution.program, execution.worlds
    nodes = nodes_of(program, worlds[0])
    steps = [tick[0] for tick in program.ticks()]
    knowledge = worlds[0].home.knowledge
    preparing = knowledge.group("preparation") | knowledge.group("takes") | knowledge.group("lets_go")
    first, last = frozenset(_worked_with(worlds[0], nodes)), frozenset(_worked_with(worlds[-1], nodes))
    found: list[Literal[Key]] = []
    since: dict[Literal[Key], int] = {}
    for tick, world in enumerate(worlds):
        now = frozenset(_worked_with(world, nodes))
        for fact in sorted(since.keys() - now, key=str):
            began = since.pop(fact)
            if fact not in first | last and any(s.action not in preparing for s in steps[began : tick - 1]):
                found.append(fact)
        for fact in now:
            since.setdefault(fact, tick)
    kept = frozenset(facts(worlds[-1], nodes, ("ON",), ()))
    found += sorted((fact for fact in last - first if fact.target is None and fact not in kept), key=str)
    return tuple(dict.fromkeys(found))


def _worked_with(world: World, nodes: Mapping[Key, int]) -> list[Literal[Key]]:
    """Return the devices switched on, the objects ON or INSIDE others, and the seats of characters."""
    switched = (Literal("ON", (key,)) for key, node in nodes.items() if world.has_state(node, "ON"))
    found = dict.fromkeys((*facts(world, nodes, ("ON",), ("ON", "INSIDE")), *switched))
    return [f for f in found if f.target is None or CHARACTER_CLASS not in (f.subject[0], f.target[0]) or _seated(f)]


def _seated(fact: Literal[Key]) -> bool:
    return fact.name == "ON" and fact.subject[0] == CHARACTER_CLASS


def _used_after(program: Program, action: str, key: Key, preparation: frozenset[str]) -> bool:
    """Return whether a thing is of use in a step after the last such action on it, preparations aside."""
    last = max((n for n, s in enumerate(program.steps) if s.action == action and _first(s) == key), default=-1)
    later = program.steps[last + 1 :]
    return any(step.action not in preparation and key in (ref.key for ref in step.objects) for step in later)


def _is_tool(program: Program, key: Key, knowledge: Knowledge) -> bool:
    """Return whether a thing was the last one taken before something was done that takes such a thing."""
    held: Key | None = None
    for step in program.steps:
        if step.action == "Grab":
            held = _first(step)
        part = knowledge.tool_of(step.action)
        if part is not None and held == key and _first(step) != key and part in key[0]:
            return True
    return False


def _first(step: Step) -> Key | None:
    return step.objects[0].key if step.objects else None


def asked(program: Program, knowledge: Knowledge) -> tuple[bool, ...]:
    """For each step, whether title or description ask for it in words: its verb, and its object by any of its names.

    Steps that only lead to others are never asked for, nor is taking back what the program itself has done.
    """
    sentences = clauses(program)
    return tuple(
        step.action not in knowledge.group("preparation")
        and not takes_back(program, number, knowledge)
        and any(_says(step, sentence, knowledge) for sentence in sentences)
        for number, step in enumerate(program.steps)
    )


def clauses(program: Program) -> list[frozenset[str]]:
    """Return the stems of each clause of title and description."""
    text = f"{program.title}. {program.description}".lower()
    return [stems(part) for part in re.split(r"[.;!?\n]|,|\band\b|\bthen\b", text)]


def takes_back(program: Program, number: int, knowledge: Knowledge) -> bool:
    """Return whether a step tidies up: puts away what was taken, or switches off what was switched on."""
    step = program.steps[number]
    if step.action in knowledge.group("forgets"):
        done = knowledge.group("takes")
    else:
        done = knowledge.achieving("ON") if knowledge.state_of(step.action) == "OFF" else frozenset()
    return any(earlier.action in done and earlier.objects == step.objects for earlier in program.steps[:number])


def _says(step: Step, sentence: frozenset[str], knowledge: Knowledge) -> bool:
    verbs = any(way <= sentence for way in action_phrases(step.action, knowledge))
    return verbs and (not step.objects or any(names_in_text(ref.name, knowledge) & sentence for ref in step.objects))


@lru_cache(maxsize=1 << 12)
def action_phrases(action: str, knowledge: Knowledge) -> tuple[frozenset[str], ...]:
    """Return the words of each phrase of an action, objects left out."""
    known = knowledge.actions.get(action)
    if known is None:
        return ()
    phrases = (re.sub(r"\{\d\}", " ", known.template), *known.words)
    return tuple(stems(phrase) - {"in", "at", "into"} for phrase in phrases)


@lru_cache(maxsize=1 << 12)
def names_in_text(name: str, knowledge: Knowledge) -> frozenset[str]:
    """Return the words by which a thing may go: those of its class's names, and of the kind above it."""
    thing = knowledge.object_class(name)
    names = {name, *knowledge.same_class(name)}
    if thing is not None:
        names |= {*thing.synonyms, *knowledge.ancestors(name)} - _ANYTHING
    return stems(" ".join(names).replace("_", " "))


@lru_cache(maxsize=1 << 14)
def stems(text: str) -> frozenset[str]:
    """Stems of the words of a text."""
    return frozenset(_stem(word) for word in re.findall(r"[a-z]+", text.lower()))


def _stem(word: str) -> str:
    """Return a word without plural, -ing and -ed: near enough to compare."""
    for ending in ("ching", "ing", "ied", "ed", "es", "s"):
        if word.endswith(ending) and len(word) - len(ending) >= 3:
            word = word[: -len(ending)] + ("ch" if ending == "ching" else "")
            break
    word = word[:-1] if len(word) > 3 and word[-1] == word[-2] else word
    return word[:-1] if len(word) > 3 and word[-1] == "e" else word
