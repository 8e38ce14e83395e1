"""Masks of action records as programs: the rules that the engine reads, in a form that kernels run.

The mask of a record is called with a situation of symbols. `&`, `|` and `~` then build an expression. Where a mask asks
for the truth of a symbol, both answers are followed. So a rule is written once, in `simulation.actions`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import STATES
from hearth.simulation.actions.common import Action
from hearth.simulation.rules import Rules
from hearth.simulation.world.states import LYING, SITTING

FLAGS = ("free_hand", "sitting", "lying", "resting", "ahead")
"""Facts of a situation that hold or not; a register has all bits or none."""

SETS = ("close", "hidden", "held", "walkable", "walked_to", "held_by_others", "full_handed", "in_use")
"""Sets of a situation that kernels compute."""

DYNAMIC = (
    "zero", "ones", "me", "worn", "room_to_sit", "room_to_lie", *FLAGS, *SETS, *(f"state_{name}" for name in STATES),
)  # fmt: skip
"""Registers that kernels fill for each agent and tick, in this order; those of the home's own sets follow."""

AND, OR, NOT = range(3)
"""Operations on registers."""

MOST_PATHS = 64
"""Ways through one mask."""

Expression = tuple[Any, ...]
"""(`set`, name) or (`and` | `or` | `not`, expressions)."""

ONES: Expression = ("set", "ones")
ZERO: Expression = ("set", "zero")


@dataclass(frozen=True)
class TracedMask:
    """The mask of an action as expressions.

    Attributes:
        possible: for an action without objects, when it can be done.
        arguments: for each argument the nodes that it may be.
    """

    possible: Expression
    arguments: tuple[Expression, ...]


@dataclass
class _Path:
    """The answers given in one way through a mask: those to come are True first, then False."""

    given: list[bool]
    taken: list[tuple[_Symbol, bool]] = field(default_factory=list)

    def ask(self, symbol: _Symbol) -> bool:
        for known, answer in self.taken:
            if known.expression == symbol.expression:
                return answer
        number = len(self.taken)
        answer = self.given[number] if number < len(self.given) else True
        self.taken.append((symbol, answer))
        return answer


class _Symbol:
    """A set of nodes that is not known yet."""

    def __init__(self, expression: Expression, path: _Path) -> None:
        self.expression = expression
        self.path = path

    def __and__(self, other: object) -> _Symbol:
        return _Symbol(_joined("and", self.expression, _expression(other)), self.path)

    __rand__ = __and__

    def __or__(self, other: object) -> _Symbol:
        return _Symbol(_joined("or", self.expression, _expression(other)), self.path)

    __ror__ = __or__

    def __invert__(self) -> _Symbol:
        return _Symbol(("not", self.expression), self.path)

    def __bool__(self) -> bool:
        return self.path.ask(self)


class _OfStates(_Symbol):
    """The nodes in a state; with the agent alone, whether the agent is in it."""

    def __init__(self, number: int, path: _Path) -> None:
        super().__init__(("set", f"state_{STATES[number]}"), path)
        self.flag = {SITTING: "sitting", LYING: "lying"}.get(number)

    def __and__(self, other: object) -> _Symbol:
        if self.flag and isinstance(other, _Symbol) and other.expression == ("set", "me"):
            return _Symbol(("set", self.flag), self.path)
        return super().__and__(other)


class _Home:
    """A home of symbols."""

    def __init__(self, path: _Path) -> None:
        self._path = path
        self.properties = _Named("property", path)

    def __getattr__(self, name: str) -> _Symbol:
        if name not in ("everything", "rooms", "characters", "furniture", "bedding"):
            raise _unreadable(f"the home's `{name}`")
        return _Symbol(("set", name), self._path)

    def able(self, action: str, position: int = 0) -> _Symbol:
        return _Symbol(("set", f"able_{action}_{position}"), self._path)


class _Named:
    """Sets of nodes by a name, such as that of a property."""

    def __init__(self, kind: str, path: _Path) -> None:
        self._kind, self._path = kind, path

    def __getitem__(self, name: str) -> _Symbol:
        return _Symbol(("set", f"{self._kind}_{name}"), self._path)


class _Me:
    """The acting agent."""

    def __init__(self, path: _Path) -> None:
        self.bit = _Symbol(("set", "me"), path)
        self.worn = _Symbol(("set", "worn"), path)

    def __getattr__(self, name: str) -> Any:
        raise _unreadable(f"the agent's `{name}`")


class _Situation:
    """A situation of symbols, with the names of `actions.situation.Situation`."""

    def __init__(self, path: _Path, rules: Rules) -> None:
        self._path, self.rules = path, rules
        self.home, self.me = _Home(path), _Me(path)
        self.states = [_OfStates(number, path) for number in range(len(STATES))]

    def __getattr__(self, name: str) -> _Symbol:
        if name not in (*FLAGS, *SETS):
            raise _unreadable(f"the situation's `{name}`")
        return _Symbol(("set", name), self._path)

    def able(self, action: str, position: int = 0) -> _Symbol:
        return self.home.able(action, position)

    def with_room(self, places: _Symbol, lying: bool, made_bed: bool) -> _Symbol:
        if made_bed != self.rules.made_bed:
            raise _unreadable("room on a bed by two rules at once")
        return places & _Symbol(("set", "room_to_lie" if lying else "room_to_sit"), self._path)


def traced(action: Action, arity: int, rules: Rules) -> TracedMask:
    """Return the mask of an action as expressions.

    Raises:
        HearthError: BAD_ARGUMENT: the mask asks for something that kernels do not know; the action then needs a kernel.
    """
    try:
        found = list(_paths(action, rules))
    except (HearthError, TypeError) as error:
        why = error.diagnostics[0].message if isinstance(error, HearthError) else str(error)
        message = f"the mask of {action.name} cannot be read as a program: {why}"
        remedy = "write it as set algebra over `Situation`, or give the action a kernel (CONTRIBUTING, `An action`)"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy) from error
    possible, arguments = ZERO, [ZERO] * arity
    for conditions, masks in found:
        possible = _joined("or", possible, conditions)
        for number, mask in enumerate(masks):
            arguments[number] = _joined("or", arguments[number], _joined("and", conditions, _expression(mask)))
    return TracedMask(possible, tuple(arguments))


def _paths(action: Action, rules: Rules) -> Iterator[tuple[Expression, tuple[Any, ...]]]:
    """Yield the flags that hold on each way through a mask, and the masks at its end."""
    rest: list[list[bool]] = [[]]
    for _ in range(MOST_PATHS):
        if not rest:
            return
        path = _Path(rest.pop())
        masks = action.mask(_Situation(path, rules))  # type: ignore[arg-type]
        for number in range(len(path.given), len(path.taken)):
            rest.append([answer for _, answer in path.taken[:number]] + [False])
        nothing = masks is None or any(_expression(mask) == ZERO for mask in masks)
        flags = ONES
        for symbol, answer in path.taken:
            if _flag(symbol.expression):
                flags = _joined("and", flags, symbol.expression if answer else ("not", symbol.expression))
            elif not answer and not nothing:  # an empty set may only mean that nothing can be done
                raise _unreadable("the truth of a set, which then allows something else")
        if not nothing and masks is not None:
            yield flags, masks
    raise _unreadable(f"more than {MOST_PATHS} ways through it")


def _flag(expression: Expression) -> bool:
    return expression[0] == "set" and expression[1] in FLAGS


def _expression(value: object) -> Expression:
    if isinstance(value, _Symbol):
        return value.expression
    if value in (0, -1):
        return ONES if value == -1 else ZERO
    raise _unreadable(f"a {type(value).__name__}")


def _joined(kind: str, one: Expression, other: Expression) -> Expression:
    """Return two expressions joined by `and` or `or`, shorter where one of them decides."""
    neutral, absorbing = (ONES, ZERO) if kind == "and" else (ZERO, ONES)
    if absorbing in (one, other):
        return absorbing
    if neutral in (one, other):
        return other if one == neutral else one
    return one if one == other else (kind, one, other)


def _unreadable(what: str) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"it asks for {what}")
