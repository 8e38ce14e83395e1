"""The program runs, but what it was for is not reached (thesis eq. A.1), or a step is done in other circumstances."""

from hearth.grounding.preconditions.usual_states import usual_states
from hearth.repair.handlers.common import Edit, RepairContext, Splice, before
from hearth.repair.handlers.posture import places_to_rest
from hearth.repair.handlers.restored_states import operates, restoring
from hearth.schemas.failures import Code
from hearth.schemas.literals import HOLDS, Key, Literal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.vocabulary import CHARACTER_CLASS


def goal_lost(context: RepairContext) -> Edit | None:
    """Bring about the first thing that is missing, things before where the character ends up."""
    for fact in sorted(context.missed, key=_rank):
        steps = _steps(context, fact)
        if steps:
            return Edit("goal_lost", (Splice(len(context.program.steps), 0, steps),))
    return None


def circumstances_lost(context: RepairContext) -> Edit | None:
    """Bring about the conditions in which the step was done: get up, then prepare things, then take the seat."""
    for fact in sorted(context.missed, key=lambda fact: (not fact.negated, _rank(fact))):
        steps = _undone(context, fact) if fact.negated else _steps(context, fact)
        if fact.name in usual_states():
            index = context.world.home.index[context.nodes[fact.subject]]
            steps = restoring(context, usual_states()[fact.name], index)
        if steps:
            usual = fact.name in usual_states() and operates(steps)
            return before(context, "circumstances_lost", *steps)._replace(stays=usual)
    return None


def _undone(context: RepairContext, fact: Literal[Key]) -> tuple[Step, ...]:
    """Let go of the held object, else get up."""
    if fact.name == HOLDS and fact.target is not None:
        return (context.does("Release", context.ref(context.world.home.index[context.nodes[fact.target]])),)
    return (context.does("StandUp"),)


def _rank(fact: Literal[Key]) -> tuple[bool, bool, bool]:
    """Edits that move the character come after those that move things; its seat comes last."""
    resting = fact.name in ("SITTING", "LYING") or (fact.name == "ON" and fact.subject[0] == CHARACTER_CLASS)
    return (resting, fact.name == HOLDS, fact.target is not None)


def _steps(context: RepairContext, fact: Literal[Key]) -> tuple[Step, ...]:
    index, nodes = context.world.home.index, context.nodes
    if fact.subject[0] == CHARACTER_CLASS:
        return _of_character(context, fact)
    if fact.subject not in nodes or (fact.target is not None and fact.target not in nodes):
        return ()
    i = index[nodes[fact.subject]]
    thing = context.ref(i)
    if fact.target is None:
        action = context.knowledge.achiever(fact.name)
        alone = bool(action) and context.knowledge.arity[action] == 1  # Cover and Wrap need a second thing
        return (Step("Walk", (thing,)), Step(action, (thing,))) if alone else ()
    held = context.world.agents[0].held >> i & 1
    fetched = () if held else (Step("Walk", (thing,)), Step("Grab", (thing,)))
    if fact.target[0] == CHARACTER_CLASS:
        return (*fetched, Step("PutOn", (thing,)))
    place = context.ref(index[nodes[fact.target]])
    return (*fetched, Step("Walk", (place,)), Step(_putting(context, fact, thing, place), (thing, place)))


def _putting(context: RepairContext, fact: Literal[Key], thing: ObjectRef, place: ObjectRef) -> str:
    """PutBack, PutIn, or Pour where the program pours it."""
    if fact.name == "ON":
        return "PutBack"
    pours = any(step.action == "Pour" and step.objects == (thing, place) for step in context.program.steps)
    return "Pour" if pours else "PutIn"


def _of_character(context: RepairContext, fact: Literal[Key]) -> tuple[Step, ...]:
    """Rest on the seat of the goal, take what it holds, or go to the room where it ends."""
    agent = fact.subject[1] - 1
    target = fact.target
    aimed = context.goal if context.failure.code is Code.GOAL_LOST else context.wanted[context.at] or ()
    if fact.name in ("SITTING", "LYING", "ON"):
        seats = [f.target for f in aimed if f.name == "ON" and f.subject == fact.subject]
        target = seats[0] if seats else None
        if target is None and aimed is not context.goal:
            action = context.knowledge.achiever(fact.name)
            places = (context.ref(index) for rest, index in places_to_rest(context) if rest == action)
            return next(((Step("Walk", (place,), agent), Step(action, (place,), agent)) for place in places), ())
    if target is None or target not in context.nodes:
        return ()
    thing = context.ref(context.world.home.index[context.nodes[target]])
    walk = Step("Walk", (thing,), agent)
    if fact.name == HOLDS:
        return (walk, Step("Grab", (thing,), agent))
    if fact.name == "INSIDE":
        return (walk,)
    lying = any(f.name == "LYING" and f.subject == fact.subject and not f.negated for f in aimed)
    return (walk, Step("Lie" if lying else "Sit", (thing,), agent))
