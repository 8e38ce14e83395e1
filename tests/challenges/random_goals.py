"""Goals of every form that the goal language has, drawn for tests of instructions."""

from __future__ import annotations

from random import Random

from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import Literal

STATES = ("ON", "OFF", "OPEN", "CLOSED", "CLEAN", "DIRTY", "PLUGGED_IN", "PLUGGED_OUT", "SITTING")
RELATIONS = ("ON", "INSIDE", "CLOSE", "FACING")
AGENTS = ("agent", "agent:0", "agent:1")
DEEPEST = 3


def random_goal(chooser: Random, knowledge, depth: int = 0, variables: tuple[str, ...] = ()) -> Goal:
    """Return a goal; what is joined in it is a goal, too."""
    counts = tuple(_literal(chooser, knowledge, variables) for _ in range(chooser.choice((1, 1, 2, 3))))
    if depth == DEEPEST or chooser.random() < 0.6:
        return Goal(counts)
    join = chooser.choice(("or", "then", "not", "exists", "forall", "always", "never", "within"))
    variable = f"?{'xyz'[depth]}" if join in ("exists", "forall") else ""
    inner = (*variables, variable) if variable else variables
    goals = (random_goal(chooser, knowledge, depth + 1, inner) for _ in range(2 if join in ("or", "then") else 1))
    ticks = chooser.randint(0, 99) if join == "within" else 0
    return Goal(counts if chooser.random() < 0.5 else (), (Joined(join, tuple(goals), variable, ticks),))


def _literal(chooser: Random, knowledge, variables: tuple[str, ...]):
    def term():
        return chooser.choice(
            [chooser.choice(sorted(knowledge.objects))] * 6 + [chooser.randint(1, 999), *variables * 3]
        )

    number, negated = chooser.choice((1, 1, 1, 2, 3, 12)), chooser.random() < 0.2
    kind = chooser.randrange(8)
    if kind < 2:
        return Literal(chooser.choice(STATES), (term(),), negated), number
    if kind < 4:
        return Literal(chooser.choice(RELATIONS), (term(), term()), negated), number
    if kind < 6:
        name = chooser.choice((*RELATIONS, "HOLDS", "HOLDS_RH"))
        return Literal(name, (chooser.choice(AGENTS), term()), negated), number
    if kind == 6:
        return Literal("SITTING", (chooser.choice(AGENTS),), negated), number
    action = knowledge.actions[chooser.choice(sorted(knowledge.actions))]
    arity = chooser.choice((action.arity, action.arity, 0))
    return Literal(action.name, tuple(term() for _ in range(arity)), False), number
