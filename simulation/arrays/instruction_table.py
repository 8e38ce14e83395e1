"""The actions of a batch as tables: what each number means, the program of its mask, and its effect.

A number is 0 to wait, an action without objects, or an action and a node: 64 + plane * nodes + node. An action of two
objects has two planes, one for the thing in each hand.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.actions.common import Action, Becomes, unchanged
from hearth.simulation.actions.metric_checks import TURN
from hearth.simulation.actions.registry import EVERY, MOVES
from hearth.simulation.arrays.mask_tracing import AND, DYNAMIC, NOT, OR, Expression, traced
from hearth.simulation.arrays.record_types import MOST_SETS
from hearth.simulation.rules import Rules
from hearth.simulation.world.states import LYING, SITTING

FIRST_NODE_NUMBER = 64
"""The first number that is about a node; those below it are for actions without objects."""

KNOWN_SETS = (
    "everything", "rooms", "doors", "furniture", "bedding", "property_LIEABLE", "property_SURFACES", "off_the_floor",
    "holders", "carriers", "rests", "seats", "movable",
)  # fmt: skip
"""Sets of a task that kernels read by their place here; those that masks read follow."""

(UNCHANGED, BECOMES, LIFT, PUT_ON, PUT_INSIDE, SETTLE, RISE, ROTATE, STRIDE_AHEAD, STRIDE_TOWARDS) = range(10)
"""Effects; the last eight have kernels of their own (`kernels.effects`)."""


class Kernel(NamedTuple):
    """The effect of an action that literals do not say.

    Attributes:
        effect: its number.
        argument: the posture of `SETTLE`, the degrees of `ROTATE`.
    """

    effect: int
    argument: int = 0


KERNELS = {
    "Grab": Kernel(LIFT),
    "PutBack": Kernel(PUT_ON),
    "PutIn": Kernel(PUT_INSIDE),
    "Sit": Kernel(SETTLE, SITTING),
    "Lie": Kernel(SETTLE, LYING),
    "StandUp": Kernel(RISE),
    "Sleep": Kernel(UNCHANGED),
    "WakeUp": Kernel(UNCHANGED),
    "Turnleft": Kernel(ROTATE, -int(TURN)),
    "Turnright": Kernel(ROTATE, int(TURN)),
    "Walkforward": Kernel(STRIDE_AHEAD),
    "Walktowards": Kernel(STRIDE_TOWARDS),
}
"""Actions with a kernel. One whose record has the effect `Becomes` or `unchanged` needs none."""

(EFFECT, ARGUMENT, HAND, FIRST, LAST, RESULT, HELD, MOVING, PLANE, NEEDS) = range(10)
"""Columns of `ActionTable.rows`: the effect and its argument; the hand of the first object or -1; the operations of the
mask; the registers of its result and of the objects in hands; whether it is a move of metres; the number of its plane
or -1; the dynamic registers that it reads, as bits."""

TEMPORARY = len(DYNAMIC) + MOST_SETS
"""The first register for intermediate results."""


@dataclass(frozen=True)
class ActionTable:
    """The actions that agents may try.

    Attributes:
        names: sorted.
        rows: int64 (rows, columns): row 0 is to wait, then actions without objects, then planes.
        program: int16 (operations, 4): operation, register, register, register of the result.
        sets: names of the sets of a task, by place in its record.
        read: places of the sets that programs read.
        of_row: action of each row, and the hand of its first object; None of waiting.
        planes: how many there are.
        registers: how many registers a program needs.
        rules: of actions.
    """

    names: tuple[str, ...]
    rows: np.ndarray
    program: np.ndarray
    sets: tuple[str, ...]
    read: np.ndarray
    of_row: tuple[tuple[str, int] | None, ...]
    planes: int
    registers: int
    rules: Rules

    @property
    def first_plane(self) -> int:
        """The row of the first plane."""
        return len(self.of_row) - self.planes

    def size(self, nodes: int) -> int:
        """Return the number of instruction numbers where sets have room for a number of nodes."""
        return FIRST_NODE_NUMBER + self.planes * nodes


def action_table(names: Iterable[str], knowledge: Knowledge, rules: Rules) -> ActionTable:
    """Return the table of some actions.

    Raises:
        HearthError: UNKNOWN_ACTION; BAD_ARGUMENT: an action lacks a kernel, or a rule is out of scope.
    """
    _check_rules(rules)
    chosen = sorted(set(names))
    if unknown := [name for name in chosen if name not in EVERY]:
        raise HearthError.of(Code.UNKNOWN_ACTION, f"`{unknown[0][:40]}` is not an action of characters at places")
    writer = _Writer()
    found: list[tuple[str, int, list[int]]] = []
    for name in chosen:
        record, arity = EVERY[name].under(rules), knowledge.arity[name]
        kernel = _effect(record, knowledge)
        for hand in (0, 1) if arity > 1 else (-1,):
            found.append((name, hand, [*kernel, hand, *writer.mask(record, arity, rules), int(name in MOVES)]))
    found.sort(key=lambda each: knowledge.arity[each[0]] > 0)
    rows = [[UNCHANGED, 0, -1, 0, 0, DYNAMIC.index("ones"), 0, 0, -1, 0]]
    planes = 0
    for name, _, row in found:
        own = knowledge.arity[name] > 0
        *before, needs, moving = row
        rows.append([*before, moving, planes if own else -1, needs])
        planes += own
    if len(rows) - planes > FIRST_NODE_NUMBER:
        raise HearthError.of(Code.BAD_ARGUMENT, f"{len(rows) - planes} actions without objects; 63 are possible")
    of_row = (None, *((name, hand) for name, hand, _ in found))
    return ActionTable(tuple(chosen), np.array(rows, np.int64), np.array(writer.program, np.int16).reshape(-1, 4),
                       tuple(writer.sets), np.array(sorted(writer.read), np.int64), of_row, planes,
                       TEMPORARY + writer.most, rules)  # fmt: skip


def _check_rules(rules: Rules) -> None:
    """Refuse rules that kernels do not know.

    Raises:
        HearthError: BAD_ARGUMENT.
    """
    known = Rules(one_grip=rules.one_grip, made_bed=rules.made_bed, near_hands=rules.near_hands, leaves_seat=True)
    if rules != known._replace(watch_needs_on=rules.watch_needs_on):
        differs = next(name for name, value in known._asdict().items() if getattr(rules, name) != value)
        message = f"the rule `{differs}` is {getattr(rules, differs)!r}, which arrays do not have"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="Env or TextHomes, with any rules")


def _effect(action: Action, knowledge: Knowledge) -> Kernel:
    """Return the effect of an action.

    Raises:
        HearthError: BAD_ARGUMENT: it needs a kernel.
    """
    if action.name in KERNELS:
        return KERNELS[action.name]
    turns = any(action.name in knowledge.group(group) for group in ("looks", "rests", "rises"))
    if isinstance(action.effect, Becomes) and not turns and action.effect.state < SITTING:
        return Kernel(BECOMES, action.effect.state)
    if action.effect is unchanged and not turns:
        return Kernel(UNCHANGED)
    message = f"the effect of {action.name} is a function; arrays need a kernel for it"
    remedy = "an effect `Becomes(state)`, or a kernel (CONTRIBUTING, `An action`)"
    raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=remedy)


class _Writer:
    """Writes the programs of masks one after another."""

    def __init__(self) -> None:
        self.program: list[tuple[int, int, int, int]] = []
        self.sets = list(KNOWN_SETS)
        self.read: set[int] = set()
        self.most = 0
        self._needs = 0
        self._next = TEMPORARY

    def mask(self, action: Action, arity: int, rules: Rules) -> list[int]:
        """Write the mask of an action; return its first and last operation, results, and needed registers."""
        found = traced(action, arity, rules)
        self._needs, self._next, first = 0, TEMPORARY, len(self.program)
        result = self._register(found.arguments[-1] if found.arguments else found.possible)
        held = self._register(found.arguments[0]) if arity > 1 else 0
        if arity > 1 and found.arguments[0] != ("set", "held"):
            message = f"the first object of {action.name} may be something that no hand holds"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="arrays number such actions by hands alone")
        self.most = max(self.most, self._next - TEMPORARY)
        return [first, len(self.program), result, held, self._needs]

    def _register(self, expression: Expression) -> int:
        """Return the register that will have an expression's value."""
        kind, *parts = expression
        if kind == "set":
            return self._named(parts[0])
        values = [self._register(part) for part in parts]
        operation = {"and": AND, "or": OR, "not": NOT}[kind]
        self.program.append((operation, values[0], values[-1], self._next))
        self._next += 1
        return self._next - 1

    def _named(self, name: str) -> int:
        if name in DYNAMIC:
            number = DYNAMIC.index(name)
            self._needs |= 1 << number
            return number
        if name not in self.sets:
            if len(self.sets) >= MOST_SETS:
                raise HearthError.of(Code.BAD_ARGUMENT, f"masks read more than {MOST_SETS} sets")
            self.sets.append(name)
        self.read.add(self.sets.index(name))
        return len(DYNAMIC) + self.sets.index(name)
