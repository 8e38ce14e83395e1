"""Goals in English: an instruction is drawn from the wordings of `instruction_wordings.yaml`.

A goal's literals become clauses, and a frame holds the clauses. `instruction_reader.py` reads the goal back.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from random import Random
from typing import NamedTuple

from hearth.challenges.instruction_object_names import EVERY, Counted, are, listed, noun, the, wordings
from hearth.kb.knowledge import Knowledge
from hearth.schemas.goals import Goal, Joined
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.rng import rng

TRAIN, TEST = "train", "test"
"""The pools of wordings for training and for tests; there is also `valid`."""

SEPARATOR = ", and "
"""Between clauses."""


class Style(NamedTuple):
    """The choice of wordings.

    Attributes:
        pool: one of the pools of the file.
        kind: `plain` or `terse`.
        doer: the agent of goals that is asked to do it.
    """

    pool: str
    kind: str
    doer: str


class Clause(NamedTuple):
    """Literals that one clause says.

    Attributes:
        key: of the clause in the file; "" where it has none.
        place: the second object of the literals, which they share; None where there is none.
        who: the agent of the literals; None where there is none, or where it is the one that is asked.
        things: what is counted.
    """

    key: str
    place: Name | None = None
    who: Name | None = None
    things: Counted = ()


def instruction(
    goal: Goal,
    knowledge: Knowledge,
    seed: int = 0,
    *,
    pool: str = TRAIN,
    doer: str = AGENT,
    family: str = "",
    terse: bool | None = None,
) -> str:
    """Return a goal as an instruction in English.

    Args:
        goal: any goal.
        knowledge: has the paraphrases of actions.
        seed: all the randomness there is.
        pool: of wordings: `train`, `valid` or `test`; no wording is in two of them.
        doer: the agent of the goal that is asked; `agent`, or `agent:0`.
        family: of `household`, which may have frames of its own.
        terse: whether the wording is terse; drawn where None.

    Examples:
        >>> from hearth.challenges.instruction_writer import instruction
        >>> goal = hearth.Goal.of((hearth.Literal.of("ON", "plate", "dining_table"), 2))
        >>> instruction(goal, known, seed=3)
        'Two plates on the dining table'
    """
    chooser = rng(seed, "instruction", pool)
    kind = "terse" if terse or (terse is None and chooser.random() < 0.25) else "plain"
    text = clauses(goal, knowledge, Style(pool, kind, doer), chooser)
    framed: str = chooser.choice(frames(pool, kind, family)).format(clauses=text)
    return framed[0].upper() + framed[1:]


def frames(pool: str, kind: str, family: str = "") -> Sequence[str]:
    """Return the frames of a pool; a family's own are half of the plain ones."""
    found: list[str] = wordings()["frames"][pool][kind]
    own = wordings()["family_frames"].get(family, {}).get(pool, []) if kind == "plain" else []
    return [*found, *(own * (len(found) // max(1, len(own))))]


def clauses(goal: Goal, knowledge: Knowledge, style: Style, chooser: Random) -> str:
    """Return the clauses of a goal."""
    found = [text for key, group in _grouped(goal, style.doer) for text in _said(key, group, knowledge, style, chooser)]
    found += [_joined(part, knowledge, style, chooser) for part in goal.parts]
    return SEPARATOR.join(found)


def _grouped(goal: Goal, doer: str) -> Iterator[tuple[Clause, list[tuple[Literal[Name], int]]]]:
    """Yield the literals that one clause can say, in the goal's order."""
    for key, group in groupby(goal, lambda pair: clause_of(pair[0], pair[1], doer)._replace(things=())):
        yield key, list(group)


def _said(
    clause: Clause, group: list[tuple[Literal[Name], int]], knowledge: Knowledge, style: Style, chooser: Random
) -> Iterator[str]:
    """Yield the texts of literals: one where a clause says them together."""
    if not clause.key:
        for literal, number in group:
            yield _other(literal, number, knowledge)
        return
    templates = wordings()["clauses"][clause.key][style.pool][style.kind]
    things = [thing for literal, number in group for thing in clause_of(literal, number, style.doer).things]
    alone = [[each] for each in things] if not _countable(clause.key) else [things]
    for some in alone:
        listing = listed(tuple(some)) if some and some[0][0] is not None else ""
        place = the(clause.place) if clause.place is not None else ""
        who = noun(clause.who) if clause.who is not None else ""
        slots = {"things": listing, "every": listing, "place": place, "who": who}
        verbs = {"are": are(tuple(some)), "sit": resting(clause.place, knowledge)}
        yield chooser.choice(templates).format(**slots, **verbs)


def resting(place: Name | None, knowledge: Knowledge) -> str:
    """Return what people do on a place: `sit`, `lie`, or `sit or lie` where both can be done, or no class is named."""
    kind = knowledge.objects.get(str(place))
    can = [word for word, name in (("sit", "SITTABLE"), ("lie", "LIEABLE")) if kind is None or name in kind.properties]
    return " or ".join(can or ["sit", "lie"])


def _countable(key: str) -> bool:
    """Return whether a clause lists things."""
    pools = wordings()["clauses"][key]
    return any(slot in pools[TRAIN]["plain"][0] for slot in ("{things}", "{every}"))


def clause_of(literal: Literal[Name], number: int, doer: str) -> Clause:
    """Return the clause that says a literal; its key is "" where there is none."""
    clause = _clause(literal, number, doer)
    return clause if clause.key in wordings()["clauses"] else Clause("")


def _clause(literal: Literal[Name], number: int, doer: str) -> Clause:
    negated = "not " if literal.negated else ""
    if (literal.negated and number != 1) or not literal.terms or len(literal.terms) > 2:
        return Clause("")
    counted = EVERY if literal.negated else number
    subject, target = literal.terms[0], literal.target
    if target is None:
        return Clause(f"{negated}{literal.name}", things=((subject, counted),)) if not is_agent(subject) else Clause("")
    if not is_agent(subject):
        worn = f"{negated}{literal.name} body"
        if target == doer and worn in wordings()["clauses"]:
            return Clause(worn, things=((subject, counted),))
        return Clause(f"{negated}{literal.name} place", target, None, ((subject, counted),))
    who = None if subject == doer else subject
    key = f"{negated}{literal.name} {'me' if who is None else 'who'}"
    if key in wordings()["clauses"] and _countable(key):
        return Clause(key, None, who, ((target, counted),))
    return Clause(key, target, who, ((None, 1),)) if number == 1 else Clause("")  # type: ignore[arg-type]


def is_agent(term: Name) -> bool:
    """Return whether a term stands for agents."""
    return isinstance(term, str) and (term == AGENT or term.startswith(f"{AGENT}:"))


def _other(literal: Literal[Name], number: int, knowledge: Knowledge) -> str:
    """Return a literal that no clause says: an action that is to be done, or a fact in the goal language."""
    other = wordings()["other"]
    act = acted(literal, knowledge) if number == 1 else None
    text = str(Goal.of((literal, number)))
    return str(other["act"].format(act=act) if act else other["fact"].format(text=text))


def acted(literal: Literal[Name], knowledge: Knowledge) -> str | None:
    """Return the paraphrase of an action that a goal names with all its objects; None if it is none."""
    action = knowledge.actions.get(literal.name)
    terms = literal.terms
    if action is None or literal.negated or len(terms) != action.arity or any(map(is_agent, terms)):
        return None
    template = action.template[0].lower() + action.template[1:]
    return str(template.format(*map(the, terms)))


def _joined(part: Joined, knowledge: Knowledge, style: Style, chooser: Random) -> str:
    """Return a part that is joined by a word; what is joined is in brackets."""
    other = wordings()["other"]
    if part.join == "not" and (act := _never(part.goals[0], knowledge)) is not None:
        return str(other["never"].format(act=act))
    parts = ", ".join(f"({clauses(goal, knowledge, style, chooser)})" for goal in part.goals)
    slots = {"variable": _called(part.variable, part.kind), "other": _called(*part.other)}
    return str(other["joined"][part.join].format(parts=parts, ticks=part.ticks, number=part.number, **slots))


def _called(variable: str, kind: str) -> str:
    """Return a variable, with the class of its things if it has one."""
    return f"{variable[1:]} (any {kind})" if kind else variable[1:]


def _never(goal: Goal, knowledge: Knowledge) -> str | None:
    """Return the action that a goal consists of; None if there is more to it, or none."""
    return acted(goal.counts[0][0], knowledge) if not goal.parts and [n for _, n in goal] == [1] else None
