"""Checks of formulas that others wrote: each predicate with its terms, no circles, and not too much written out."""

from collections import Counter
from collections.abc import Iterator, Mapping

from hearth.kb.formula import GONE, OPTION, And, Count, Effect, Formula, Or, Some, Term, free
from hearth.kb.knowledge_records import Action
from hearth.kb.loading.source_files import Entry, Faults
from hearth.schemas.literals import Literal
from hearth.schemas.vocabulary import EVERY_STATE, RELATIONS

Derived = Mapping[str, tuple[Literal[Term], Formula]]
"""Definitions by predicate."""

TERMS: Mapping[str, tuple[int, ...]] = {
    **dict.fromkeys(RELATIONS, (2,)),
    **dict.fromkeys(("state", "property", "class", "class_contains", "came_from", "same"), (2,)),
    **dict.fromkeys(("affords", "is_room", OPTION), (1,)),
    "REMEMBERS": (1, 2),
}
"""Numbers of terms of relations and built-in predicates; a predicate that remembers its place may leave the place open.
"""

LIMITS = ("seat_limit", "bed_limit")
"""Numbers that are known of a thing."""

MOST = 10_000
"""Predicates of a definition in which those that it uses are written out, as planners need it."""


MOST_SEARCHED = 3
"""Variables that stand for any thing at once: the time to look for all grows with the power of their number."""


def check_derived(derived: Derived, entries: Mapping[str, Entry], faults: Faults) -> None:
    """Note definitions that cannot be used; `entries` are by predicate, too."""
    sizes: dict[str, int] = {}
    for name, (head, body) in derived.items():
        entry = entries[name]
        variables = [term.name for term in head.terms]
        if any(term.function for term in head.terms) or len({*variables}) < len(variables):
            faults.at(entry, f"`{head}` has other terms than different variables")
        check_formula(body, {*variables}, str(head), derived, entry, faults)
        if any(part.name == "affords" for part in _asked(body)):
            faults.at(entry, f"`{head}`: what is afforded depends on an action", "say so in its checks")
        if _size(name, derived, sizes, ()) > MOST:
            faults.at(entry, f"`{name}` follows from itself, or stands for more than {MOST:,} predicates")


def check_literals(action: Action, derived: Derived, at: Entry, faults: Faults) -> None:
    """The same of all that an action asks for and changes, by whichever action set."""
    bound = {"a", *"os"[: action.arity]}
    parts: list[tuple[Formula, set[str]]] = [(condition.formula, bound) for condition in action.preconditions]
    effects = list(action.effects)
    if action.later is not None:
        checks = (*action.later.preconditions, *action.later.unless)
        parts += [(condition.formula, bound) for condition in checks]
        effects += action.later.effects
    for part, variables in parts:
        check_formula(part, variables, action.name, derived, at, faults)
    for effect in effects:
        check_effect(effect, bound, action.name, derived, at, faults)


def check_effect(effect: Effect, bound: set[str], whose: str, derived: Derived, at: Entry, faults: Faults) -> None:
    """Note what is wrong with an effect of given variables: what it is about, where it holds, and which state."""
    variables, literal = bound | {*effect.variables}, effect.literal
    check_formula(effect.condition, variables, whose, derived, at, faults, len(effect.variables))
    if literal.name != GONE:
        check_formula(literal.atom, variables, whose, derived, at, faults)
    elif len(literal.terms) != 1 or literal.negated or not {literal.terms[0].name} <= variables:
        faults.at(at, f"`{effect}` is not an effect", "one thing is gone, and for ever: `gone(o)`")


MOST_SHOWN = 200
"""Characters of a formula that a refusal repeats."""


def _short(formula: object) -> str:
    text = str(formula)
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]} ..."


def check_formula(
    formula: Formula, variables: set[str], whose: str, derived: Derived, at: Entry, faults: Faults, searched: int = 0
) -> None:
    """Note predicates that nothing defines or that have other terms, and variables that nothing binds.

    Variables that are looked for in one another are noted, too, where they are too many; `searched` of the formula's
    arguments are, for which it is asked of all things.
    """
    known = {*TERMS, *derived}
    for unknown in sorted({part.name for part in _asked(formula)} - known):
        faults.at(at, f"in `{_short(formula)}`: nothing says what `{unknown}` is", "see derived.yaml")
    for part in _asked(formula):
        wanted = (len(derived[part.name][0].terms),) if part.name in derived else TERMS.get(part.name, ())
        if wanted and len(part.terms) not in wanted:
            faults.at(at, f"`{_short(part)}` has {len(part.terms)} terms, not {wanted[-1]}")
    for part in _asked(formula):
        if part.name == "state" and len(part.terms) == 2 and part.terms[1].name not in EVERY_STATE:
            words = f"`{_short(part)}`: nothing can be brought into that state"
            faults.at(at, words, f"one of {', '.join(EVERY_STATE)}")
    for limit in sorted({part.limit.function for part in _parts(formula) if isinstance(part, Count)} - {*LIMITS}):
        faults.at(at, f"in `{_short(formula)}`: `{limit}` is not a number of things", f"one of {', '.join(LIMITS)}")
    for unbound in sorted(free(formula) - variables):
        faults.at(at, f"in `{_short(formula)}`: `{unbound}` is not an argument of {whose} and is not bound")
    if searched + (nested := _nested(formula, derived, {})) > MOST_SEARCHED:
        found = f"in `{_short(formula)}`: {searched + nested} variables stand for any thing at once"
        faults.at(at, found, f"at most {MOST_SEARCHED}: `some` and `count` in fewer others")


def _parts(formula: Formula) -> Iterator[Formula]:
    """Yield a formula and all parts of it."""
    yield formula
    if not isinstance(formula, Literal):
        for part in formula.parts if isinstance(formula, And | Or) else (formula.part,):
            yield from _parts(part)


def _asked(formula: Formula) -> Iterator[Literal[Term]]:
    return (part for part in _parts(formula) if isinstance(part, Literal))


def _nested(formula: Formula, derived: Derived, found: dict[str, int]) -> int:
    """Return how many variables a formula binds within one another, in the predicates that it uses, too.

    Each predicate is counted once, in `found`: definitions that use two others each would take exponential time.
    """
    if isinstance(formula, Literal):
        name = formula.name
        if name in derived and name not in found:
            found[name] = 0  # a predicate that follows from itself is refused elsewhere
            found[name] = _nested(derived[name][1], derived, found)
        return found.get(name, 0)
    parts = formula.parts if isinstance(formula, And | Or) else (formula.part,)
    inner = max((_nested(part, derived, found) for part in parts), default=0)
    return inner + isinstance(formula, Some | Count)


def _size(name: str, derived: Derived, sizes: dict[str, int], within: tuple[str, ...]) -> int:
    """Return how many predicates a definition stands for; more than `MOST` where it follows from itself."""
    if name not in derived:
        return 1
    if name in within:
        return MOST + 1
    if name not in sizes:
        used = Counter(part.name for part in _asked(derived[name][1]))
        found = sum(number * _size(each, derived, sizes, (*within, name)) for each, number in used.items())
        sizes[name] = min(found, MOST + 1)
    return sizes[name]
