"""The program runs, but what it was for is not reached: bring that about at the end (thesis eq. A.1)."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Splice, Trouble
from hearth.schemas.literals import HOLDS, Key, Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import CHARACTER_CLASS


def goal_lost(trouble: Trouble) -> Edit | None:
    """Bring about the first thing that is missing, things before where the character ends up."""
    for fact in sorted(trouble.missed, key=_rank):
        steps = _steps(trouble, fact)
        if steps:
            return Edit("goal_lost", (Splice(len(trouble.program.steps), 0, steps),))
    return None


def _rank(fact: Literal[Key]) -> tuple[bool, bool, bool]:
    """What moves the character comes after what moves things; what it rests on comes last."""
    resting = fact.name in ("SITTING", "LYING") or (fact.name == "ON" and fact.subject[0] == CHARACTER_CLASS)
    return (resting, fact.name == HOLDS, fact.target is not None)


def _steps(trouble: Trouble, fact: Literal[Key]) -> tuple[Step, ...]:
    index, nodes = trouble.world.home.index, trouble.nodes
    if fact.subject[0] == CHARACTER_CLASS:
        return _of_character(trouble, fact)
    if fact.subject not in nodes or (fact.target is not None and fact.target not in nodes):
        return ()
    i = index[nodes[fact.subject]]
    thing = trouble.ref(i)
    if fact.target is None:
        action = trouble.knowledge.achiever(fact.name)
        return (Step("Walk", (thing,)), Step(action, (thing,))) if action else ()
    held = trouble.world.agents[0].held >> i & 1
    fetched = () if held else (Step("Walk", (thing,)), Step("Grab", (thing,)))
    if fact.target[0] == CHARACTER_CLASS:
        return (*fetched, Step("PutOn", (thing,)))
    place = trouble.ref(index[nodes[fact.target]])
    return (*fetched, Step("Walk", (place,)), Step(_putting(trouble, fact, thing, place), (thing, place)))


def _putting(trouble: Trouble, fact: Literal[Key], thing: ObjectRef, place: ObjectRef) -> str:
    """PutBack, PutIn, or Pour where the program pours it."""
    if fact.name == "ON":
        return "PutBack"
    pours = any(step.action == "Pour" and step.objects == (thing, place) for step in trouble.program.steps)
    return "Pour" if pours else "PutIn"


def _of_character(trouble: Trouble, fact: Literal[Key]) -> tuple[Step, ...]:
    """Rest on the seat of the goal, take what it holds, or go to the room where it ends."""
    agent = fact.subject[1] - 1
    target = fact.target
    if fact.name in ("SITTING", "LYING", "ON"):
        seats = [f.target for f in trouble.goal if f.name == "ON" and f.subject == fact.subject]
        target = seats[0] if seats else None
    if target is None or target not in trouble.nodes:
        return ()
    thing = trouble.ref(trouble.world.home.index[trouble.nodes[target]])
    walk = Step("Walk", (thing,), agent)
    if fact.name == HOLDS:
        return (walk, Step("Grab", (thing,), agent))
    if fact.name == "INSIDE":
        return (walk,)
    lying = any(f.name == "LYING" and f.subject == fact.subject for f in trouble.goal)
    return (walk, Step("Lie" if lying else "Sit", (thing,), agent))
