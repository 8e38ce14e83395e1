"""Action sets: the checks and effects of an action in each of them (see `version.ACTION_SET`)."""

from collections.abc import Mapping
from dataclasses import replace

from hearth.kb.formula import Or
from hearth.kb.knowledge_records import Action, Condition, Consequence
from hearth.schemas.vocabulary import EVERY_STATE, STATES
from hearth.version import ACTION_SET, NEXT_ACTION_SET

USUAL = 2
"""The set of knowledge, rules and challenges for which no other is asked, and of datasets that name none."""

LATEST = 3
"""The set in which every action is executed and has consequences."""

NEW_DATASETS = LATEST
"""The set of datasets that are built without another being asked."""


def states_of_set(number: int) -> tuple[str, ...]:
    """Return the names of the states that worlds of a set have."""
    return EVERY_STATE if number == LATEST else STATES


def name_of_set(number: int) -> str:
    """Return the name under which datasets publish a set."""
    return {USUAL: ACTION_SET, LATEST: NEXT_ACTION_SET}[number]


def number_of_set(name: object) -> int:
    """Return the number of a published set: 3, or 2 for that and all that were before."""
    return LATEST if name == NEXT_ACTION_SET else USUAL


def in_set(action: Action, number: int, actions: Mapping[str, Action]) -> Action:
    """Return an action of set 2 with the checks and effects of a set.

    An act that is like another has the other's checks and effects, without what set 3 adds to these.

    Args:
        action: as the files have it, of set 2.
        number: of the set.
        actions: all of set 2, by name.
    """
    later = action.later
    if number != LATEST:
        return action
    if later is None:
        return action if action.executed else replace(action, executed=True)  # a move by metres
    base = actions[later.like] if later.like else action
    checks, effects = excused(base.preconditions, later) + later.preconditions, base.effects + later.effects
    return replace(action, executed=True, preconditions=checks, effects=effects)


def excused(checks: tuple[Condition, ...], later: Consequence) -> tuple[Condition, ...]:
    """Return the checks of sets 1 and 2 as set 3 makes them: some hold in one more case."""
    more = {each.code: each.formula for each in later.unless}
    return tuple(
        check._replace(formula=Or((check.formula, more[check.code]))) if check.code in more else check
        for check in checks
    )
