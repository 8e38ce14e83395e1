"""Every action that is executed, by its canonical name; the files name theirs in `ACTIONS`."""

from hearth.simulation.actions import (
    appliances,
    cleaning,
    clothes,
    food,
    hands,
    locomotion,
    metric_checks,
    moving,
    posture,
    senses,
)
from hearth.simulation.actions.common import Action

ACTIONS: dict[str, Action] = {
    action.name: action
    for action in (
        *appliances.ACTIONS,
        *cleaning.ACTIONS,
        *clothes.ACTIONS,
        *food.ACTIONS,
        *hands.ACTIONS,
        *locomotion.ACTIONS,
        *moving.ACTIONS,
        *posture.ACTIONS,
        *senses.ACTIONS,
    )
}

MOVES: dict[str, Action] = {action.name: action for action in metric_checks.ACTIONS}
"""The actions of characters at places; programs may use them, and in homes without geometry nothing executes them."""

EVERY = ACTIONS | MOVES
"""Options of a character at a place."""
