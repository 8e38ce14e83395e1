"""Instructions as numbers, for learners: three codes of the same instructions, each with its mask, both ways.

- `Triples`: (action, first object, second object). The masks give the legal objects of each action, so that a policy
  can choose first the action, then its objects; all of these are legal, but for an object named twice.
- `Listed`: the number of a legal instruction in the order of `Legal`, with the list itself in the observation. Every
  number below the list's length is possible; the meaning of a number differs from tick to tick.
- `Fixed`: the number of an instruction in a list that never changes; for small worlds (see `fixed_list`).

Number 0 is to wait, in all three. Objects are numbered by their slots in the arrays (see `node_slots.Slots`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from hearth.envs.node_slots import Slots
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import MOST_OBJECTS, ObjectRef, Step
from hearth.schemas.syntax import print_step
from hearth.simulation.actions.legal import Legal

if TYPE_CHECKING:
    from gymnasium.spaces import Space

WAIT = 0
"""The number of doing nothing."""

Number = Any
"""An action as a library gives it: an int, a numpy integer, or an array of three of them."""


def played(knowledge: Knowledge) -> tuple[str, ...]:
    """Return the actions that agents of a challenge may try, by name."""
    return tuple(sorted(knowledge.group("played")))


class ActionCode(Protocol):
    """A numbering of instructions."""

    def space(self) -> Space[Any]:
        """Return all numbers."""

    def spaces(self) -> dict[str, Space[Any]]:
        """Return the spaces of the arrays that `masks` returns."""

    def masks(self, legal: Legal, slots: Slots) -> dict[str, NDArray[Any]]:
        """Return the numbers that are possible now, as new arrays."""

    def read(self, number: Number, legal: Legal, slots: Slots) -> Step | Failure | None:
        """Return the instruction of a number; None to wait; a failure, where no instruction has it now.

        Raises:
            HearthError: BAD_ARGUMENT, where it is not in the space.
        """

    def number(self, step: Step | None, legal: Legal, slots: Slots) -> Number:
        """Return the number of an instruction.

        Raises:
            HearthError: BAD_ARGUMENT, where it has none.
        """


@dataclass(frozen=True)
class Triples:
    """(action, first object, second object); an object that an action does not take has number 0, and is not read.

    Attributes:
        names: the actions, numbered from 1.
        nodes: number of slots.

    The masks are `legal_actions`, int8 (1 + actions), and `legal_objects`, int8 (1 + actions, 2, slots).
    """

    names: tuple[str, ...]
    nodes: int

    def space(self) -> Space[Any]:
        """`MultiDiscrete`."""
        from gymnasium.spaces import MultiDiscrete

        return MultiDiscrete([1 + len(self.names), self.nodes, self.nodes])

    def spaces(self) -> dict[str, Space[Any]]:
        """Return the spaces of the two masks."""
        from gymnasium.spaces import MultiBinary

        count = 1 + len(self.names)
        return {
            "legal_actions": MultiBinary(count),
            "legal_objects": MultiBinary((count, MOST_OBJECTS, self.nodes)),
        }

    def masks(self, legal: Legal, slots: Slots) -> dict[str, NDArray[Any]]:
        """Return the two masks."""
        actions = np.zeros(1 + len(self.names), np.int8)
        objects = np.zeros((1 + len(self.names), MOST_OBJECTS, self.nodes), np.int8)
        actions[WAIT] = 1
        objects[:, :, 0] = 1
        places: list[tuple[int, int]] = []
        sets: list[int] = []
        for number, name in enumerate(self.names, 1):
            masks = legal.masks.get(name)
            if masks is not None and all(mask & slots.mask for mask in masks):
                actions[number] = 1
                places += [(number, position) for position in range(len(masks))]
                sets += masks
        if sets:
            objects[tuple(np.transpose(places))] = slots.rows(sets)
        return {"legal_actions": actions, "legal_objects": objects}

    def read(self, number: Number, legal: Legal, slots: Slots) -> Step | None:
        """Return the instruction of three numbers; one about an empty slot is about no node, and fails."""
        action, *objects = _triple(number, (1 + len(self.names), self.nodes, self.nodes))
        if action == WAIT:
            return None
        name = self.names[action - 1]
        taken = objects[: legal.home.knowledge.arity[name]]
        return Step(name, tuple(slots.reference(slot) for slot in taken), legal.agent)

    def number(self, step: Step | None, legal: Legal, slots: Slots) -> NDArray[np.int64]:
        """Three numbers."""
        if step is None:
            return np.zeros(1 + MOST_OBJECTS, np.int64)
        if step.action not in self.names or len(step.objects) > MOST_OBJECTS:
            raise _unnumbered(step)
        found = [slots.slot(ref) for ref in step.objects]
        if None in found:
            raise _unnumbered(step)
        return np.array([1 + self.names.index(step.action), *found, *[0] * (MOST_OBJECTS - len(found))], np.int64)


@dataclass(frozen=True)
class Listed:
    """The number of a legal instruction: by action name, then ids, as `Legal` lists them; from 1.

    Attributes:
        names: the actions; their numbers in `candidates`, from 1.
        size: length of the padded list. Legal instructions beyond it have no number.

    With the mask, `action_mask`, int8 (size), comes `candidates`, int16 (size, 3): each as a triple of `Triples`.
    """

    names: tuple[str, ...]
    size: int

    def space(self) -> Space[Any]:
        """`Discrete`."""
        from gymnasium.spaces import Discrete

        return Discrete(self.size)

    def spaces(self) -> dict[str, Space[Any]]:
        """Return the spaces of mask and candidates."""
        from gymnasium.spaces import Box, MultiBinary

        shape = (self.size, 1 + MOST_OBJECTS)
        return {"action_mask": MultiBinary(self.size), "candidates": Box(0, np.iinfo(np.int16).max, shape, np.int16)}

    def masks(self, legal: Legal, slots: Slots) -> dict[str, NDArray[Any]]:
        """Mask and candidates."""
        candidates = np.zeros((self.size, 1 + MOST_OBJECTS), np.int16)
        end = 1
        for number, name in enumerate(self.names, 1):
            masks = legal.masks.get(name)
            if masks is None:
                continue
            choices = slots.choices(masks)[: self.size - end]
            part = candidates[end : end + len(choices)]
            part[:, 0] = number
            if masks and choices:
                part[:, 1 : 1 + len(masks)] = choices
            end += len(choices)
        mask = np.zeros(self.size, np.int8)
        mask[:end] = 1
        return {"action_mask": mask, "candidates": candidates}

    def read(self, number: Number, legal: Legal, slots: Slots) -> Step | Failure | None:
        """Return the instruction at that place of the list."""
        (place,) = _triple(number, (self.size,))
        if place == WAIT:
            return None
        found = slots.instruction(legal, place - 1)
        if found is None:
            expected = "the number of a legal instruction (see `action_mask`)"
            return Failure(Code.BAD_ARGUMENT, agent=legal.agent, expected=expected, actual=str(place))
        return found

    def number(self, step: Step | None, legal: Legal, slots: Slots) -> int:
        """Return the instruction's place in the list."""
        if step is None:
            return WAIT
        for place, other in enumerate(islice(slots.instructions(legal), self.size - 1), 1):
            if (other.action, *other.objects) == (step.action, *step.objects):
                return place
        raise _unnumbered(step)


@dataclass(frozen=True)
class Fixed:
    """The number of an instruction in a list that stays the same; from 1.

    Attributes:
        steps: the instructions, about nodes of one home, or of homes whose nodes have the same ids.
    """

    steps: tuple[Step, ...]

    def space(self) -> Space[Any]:
        """`Discrete`."""
        from gymnasium.spaces import Discrete

        return Discrete(1 + len(self.steps))

    def spaces(self) -> dict[str, Space[Any]]:
        """Return the space of the mask."""
        from gymnasium.spaces import MultiBinary

        return {"action_mask": MultiBinary(1 + len(self.steps))}

    def masks(self, legal: Legal, slots: Slots) -> dict[str, NDArray[Any]]:
        """Return the mask."""
        mask = np.ones(1 + len(self.steps), np.int8)
        mask[1:] = [_legal(step, legal) for step in self.steps]
        return {"action_mask": mask}

    def read(self, number: Number, legal: Legal, slots: Slots) -> Step | None:
        """Return the instruction at that place of the list."""
        (place,) = _triple(number, (1 + len(self.steps),))
        if place == WAIT:
            return None
        step = self.steps[place - 1]
        return Step(step.action, step.objects, legal.agent)

    def number(self, step: Step | None, legal: Legal, slots: Slots) -> int:
        """Return the instruction's place in the list."""
        if step is None:
            return WAIT
        for place, other in enumerate(self.steps, 1):
            if (other.action, *other.objects) == (step.action, *step.objects):
                return place
        raise _unnumbered(step)


def fixed_list(names: Iterable[str], slots: Slots, places: Mapping[str, Sequence[int]] | None = None) -> Fixed:
    """Return every instruction of some actions about nodes in slots that the knowledge allows.

    Of two objects, the first is something that can be grabbed.

    Args:
        names: the actions.
        slots: the nodes; some ten of them, because two of them make a hundred pairs.
        places: action -> ids of the nodes that its last object may be; any node in a slot where it is not named.
    """
    home = slots.home
    grabbable = home.able("Grab", 0)
    steps = []
    for name in sorted(names):
        arity = home.knowledge.arity[name]
        sets = [home.able(name, position) & slots.mask for position in range(arity)]
        if arity == MOST_OBJECTS:
            sets[0] &= grabbable
        nodes = [[home.ids[i] for i in slots.ordered(each)] for each in sets]
        if nodes and places is not None and name in places:
            nodes[-1] = [node for node in nodes[-1] if node in places[name]]
        for chosen in product(*nodes):
            if len(set(chosen)) == arity:
                refs = (ObjectRef(home.classes[home.index[node]], 0, node) for node in chosen)
                steps.append(Step(name, tuple(refs)))
    return Fixed(tuple(steps))


def str_step(step: Step | None) -> str:
    """Return an instruction as text, without its agent; `wait` for none."""
    return "wait" if step is None else print_step(Step(step.action, step.objects))


def _legal(step: Step, legal: Legal) -> bool:
    masks = legal.masks.get(step.action)
    if masks is None:
        return False
    index = legal.home.index
    return all(
        ref.node in index and mask >> index[ref.node] & 1 for ref, mask in zip(step.objects, masks, strict=False)
    )


def _triple(number: Number, most: tuple[int, ...]) -> list[int]:
    """Return the numbers, each below its bound."""
    try:
        found = np.asarray(number)
        good = found.size == len(most) and np.issubdtype(found.dtype, np.integer)
    except (TypeError, ValueError):
        good = False
    values = found.reshape(-1).tolist() if good else []
    if not good or any(not 0 <= each < bound for each, bound in zip(values, most, strict=True)):
        wanted = (
            f"{len(most)} integers from 0, below {most}" if len(most) > 1 else f"an integer from 0 to {most[0] - 1}"
        )
        raise HearthError.of(Code.BAD_ARGUMENT, f"an action is {wanted}, not {str(number)[:60]}")
    return [int(each) for each in values]


def _unnumbered(step: Step) -> HearthError:
    return HearthError.of(Code.BAD_ARGUMENT, f"{str_step(step)} has no number now")
