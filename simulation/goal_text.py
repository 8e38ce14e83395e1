"""Goals as text, as the Embodied Agent Interface writes them: literals, actions, alternatives, order.

    goal    both [then both]...          the parts are reached in this order (see `goal_trace`); `then` binds loosest
    both    one [and one]...             [or ...] binds between `then` and `and`
    one     NAME(term, ...)[: count]     a state or relation: `ON(television)`, `ON(plate, table): 2`
            not NAME(term, ...)          of nothing: `not ON(plate, table)` is a table without plates
            ACTION[(term, ...)]          an action that is done: `WATCH`, `PUTIN(milk, fridge)`; `[Open](fridge)`
            not one | (goal)
            always one | never one       at every time up to the end; in `A then always B` from A on
            one within n                 at some time of the first n ticks; in `A then B within n` from A on
            exists x. (goal)             for some thing x; `forall x. (goal)` for all
            exists x: class. (goal)      for some thing of a class; `forall x: class. (goal)` for all
            forn n x: class. (goal)      for exactly n things
            forpairs x: class, y: class. (goal)   each thing of the smaller class with another one of the larger
    term    a class, a node (`41`, `television.410`), `agent`, `agent:1`, or a variable

`|` is `or`, `&` is `and`. Words and names may have any case. `ONTOP` is ON of two, `NEXT_TO` is CLOSE.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import LASTING, Goal, Joined
from hearth.schemas.literals import AGENT, Literal, Name
from hearth.schemas.numbers import number_of
from hearth.schemas.tokens import Tokens
from hearth.schemas.vocabulary import CHARACTER_CLASS, EVERY_STATE_ID
from hearth.simulation.goal_trace import acts
from hearth.simulation.goals import RELATED, check, unknown
from hearth.simulation.literal_truth import nodes
from hearth.simulation.world.home import Home

OTHER_NAMES = {"ONTOP": "ON", "NEXT_TO": "CLOSE"}
"""Relations of the Embodied Agent Interface, by its names."""

QUANTIFIERS = ("exists", "forall", "forn", "forpairs")
"""Words of goals about some things, all, exactly so many, or pairs."""

VARIABLES = 2
"""Variables within one another: each multiplies the cost by the number of things."""

MOST_TICKS = 10_000
"""Largest number of ticks of `within`."""

MOST = 1_000
"""States, relations and actions of a goal: each is looked at in every tick."""


def read_goal(given: str | Mapping[str, Any], home: Home, file: str = "goal") -> Goal:
    """Return a goal from text, or from a record of the Embodied Agent Interface: `vh_goal`, or a task with it or
    `tl_goal`.

    Of a `vh_goal`, the actions are done in their order, and its states and relations hold at the end. One with neither
    is a goal that holds at once, as 4 of the interface's 342 are; a text that is empty is a fault.

    Args:
        given: text or record.
        home: for names and nodes.
        file: the name of its place in faults.

    Raises:
        HearthError: SYNTAX, UNKNOWN_ACTION, UNKNOWN_OBJECT, UNKNOWN_AGENT or WRONG_ARITY, with line and column.

    Examples:
        >>> goal = hearth.read_goal("OPEN(fridge) then HOLDS(agent, milk) and (LOOKAT or WATCH)", home)
        >>> hearth.Progress.of(hearth.read_goal("OPEN(fridge) then GRAB(milk)", home), execution).satisfied
        True
    """
    if isinstance(given, Mapping):
        whole = given.get("tl_goal") or given.get("vh_goal") or given
        given = whole if isinstance(whole, str) else _release_text(whole, file)
        if not given:
            return Goal()
    return _Parser(given, file, home).whole(_Parser.ordered)


def _release_text(record: Any, file: str) -> str:
    """Return a `vh_goal` as text."""
    try:
        if not {"actions", "goal"} & record.keys():
            raise KeyError("actions")
        done = [f"({each.replace(' ', '')})" for each in record.get("actions", ())]
        facts = " and ".join(_fact(each) for each in record.get("goal", ()))
        return " then ".join([*done, facts] if facts else done)
    except (AttributeError, KeyError, TypeError) as error:
        hint = 'give text, {"tl_goal": TEXT} or {"actions": [...], "goal": [...]}'
        lacking = f"it has no {error}" if isinstance(error, KeyError) else str(error)
        raise HearthError.of(Code.BAD_JSON, f"not a goal: {lacking}", file=file, suggestion=hint) from None


def _fact(each: Mapping[str, Any]) -> str:
    if "state" in each:
        return f"{each['state']}({each['class_name']}.{each['id']})"
    return f"{each['relation_type']}({each['from_id']}, {each['to_id']})"


class _Parser(Tokens):
    PATTERN = re.compile(r"[()\[\]|&:,]|[0-9]+|agent:[0-9]+|[^\W\d]\w*(?:-\w+)*(?:\.[0-9]+)?|\.")

    def __init__(self, text: str, file: str, home: Home) -> None:
        super().__init__(text, file)
        self.home = home
        self.variables: tuple[str, ...] = ()
        self.counted = 0

    def ordered(self) -> Goal:
        place = self.next
        goals = self.several(self.alternatives, "then")
        if any(goal.lasts for goal in goals[:-1]):
            message, remedy = f"{' and '.join(LASTING)} are about the time up to the end", "write that part last"
            raise self.fault(message, suggestion=remedy, ahead=place - self.next)
        return self._joined("then", goals)

    def alternatives(self) -> Goal:
        return self._joined("or", self.several(self.conjunction, "or", "|"))

    def conjunction(self) -> Goal:
        first, *rest = self.several(self.one, "and", "&")
        for goal in rest:
            first &= goal
        return first

    def _joined(self, join: str, goals: tuple[Goal, ...]) -> Goal:
        return goals[0] if len(goals) == 1 else Goal(parts=(Joined(join, goals),))

    def one(self) -> Goal:
        return self.deeper(self._one)

    def _one(self) -> Goal:
        goal = self._unbounded()
        while self.peek().lower() == "within":
            self.take()
            number = number_of(self.peek())
            if number is None or number > MOST_TICKS:
                found = self.peek()[:20] or "the end"
                raise self.fault(f"expected a number of ticks, at most {MOST_TICKS:,}, but found `{found}`")
            self.take()
            goal = Goal(parts=(Joined("within", (goal,), ticks=number),))
        return goal

    def _unbounded(self) -> Goal:
        word = self.peek().lower()
        if word == "not":
            self.take()
            return self._negated()
        if word in LASTING:
            self.take()
            return Goal(parts=(Joined(word, (self.one(),)),))
        if word in QUANTIFIERS:
            return self._quantified(self.take().lower())
        return self._bracketed() if word == "(" else self._counted()

    def _negated(self) -> Goal:
        """`not NAME(term, ...)` of a state or relation is a literal, counted like others; else a goal is negated."""
        is_literal = self.peek().lower() not in ("(", "not", *QUANTIFIERS, *LASTING)
        goal = self.one()
        match goal.counts:
            case ((literal, 1),) if is_literal and not self.variables and not acts(literal, self.home):
                return Goal.of(literal._replace(negated=True))
        return Goal(parts=(Joined("not", (goal,)),))

    def _bracketed(self) -> Goal:
        self.take("(")
        goal = self.ordered()
        self.take(")")
        return goal

    def _quantified(self, join: str) -> Goal:
        outer, number = self.variables, 0
        if join == "forn":
            number = number_of(self.peek()) or 0
            if not number:
                raise self.fault(f"expected a number of things but found `{self.peek()[:20] or 'the end'}`")
            self.take()
        named = [self._variable(needs_class=join in ("forn", "forpairs"))]
        if join == "forpairs":
            self.take(",")
            named.append(self._variable(needs_class=True))
        if len(outer) + len(named) > VARIABLES:
            raise self.fault(f"more than {VARIABLES} variables within one another", ahead=-1)
        self.take(".")
        self.variables = (*outer, *(name for name, _ in named))
        goal = self._bracketed()
        self.variables = outer
        (variable, kind), other = named[0], named[-1] if len(named) > 1 else ("", "")
        return Goal(parts=(Joined(join, (goal,), variable, kind=kind, number=number, other=other),))

    def _variable(self, needs_class: bool) -> tuple[str, str]:
        """Return a variable, and the class of its things or ""."""
        name = "?" + self.name()
        if self.peek() != ":":
            if needs_class:
                raise self.fault("expected `: CLASS` behind the variable")
            return name, ""
        self.take(":")
        kind = self.name()
        if fault := unknown(kind, self.home):
            raise self.fault(*fault, ahead=-1)
        return name, kind

    def _counted(self) -> Goal:
        self.counted += 1
        if self.counted > MOST:
            raise self.fault(f"more than {MOST:,} states, relations and actions")
        place = self.next
        bracketed = self.peek() == "[" and bool(self.take())
        word = self.name()
        if bracketed:
            self.take("]")
        terms: tuple[Name, ...] = ()
        if self.peek() == "(":
            self.take()
            terms = () if self.peek() == ")" else self.several(self.term, ",")
            self.take(")")
        literal = Literal(self._named(word, len(terms), bracketed), terms)
        if fault := check(literal, self.home):
            raise self.fault(*fault, ahead=place - self.next)
        if self.peek() != ":":
            return Goal.of(literal)
        self.take()
        number = number_of(self.peek())
        if not number:
            raise self.fault(f"expected a count but found `{self.peek()[:20] or 'the end'}`")
        self.take()
        return Goal.of((literal, number))

    def _named(self, word: str, terms: int, bracketed: bool) -> str:
        """Return the name of a state or relation, of an action, or the word itself."""
        name = OTHER_NAMES.get(word.upper(), word.upper())
        action = self.home.knowledge.action(word)
        if not bracketed and ((terms == 1 and name in EVERY_STATE_ID) or (terms == 2 and name in RELATED)):
            return name
        return action.name if action else name

    def term(self) -> Name:
        word = self.take()
        if "?" + word in self.variables:
            return "?" + word
        kind, _, digits = word.rpartition(".")
        node = number_of(digits) if kind or word[:1].isdigit() else None
        if kind and not nodes(node or 0, self.home) & nodes(kind, self.home):
            raise self.fault(f"the home has no `{word}`", Code.UNKNOWN_OBJECT, ahead=-1)
        found = AGENT if word == CHARACTER_CLASS else word if node is None else node
        if fault := unknown(found, self.home):
            raise self.fault(*fault, ahead=-1)
        return found
