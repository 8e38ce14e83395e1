"""Steps of ours for the plan of an ALFRED trajectory."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from importlib.resources import files
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.kb.spelling import key_of
from hearth.schemas.failures import Code


class UnreadableStepError(ValueError):
    """A step of a plan that has no counterpart."""

    def __init__(self, code: Code, message: str, remedy: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.remedy = remedy


def steps_of(plan: Mapping[str, Any], knowledge: Knowledge) -> list[str]:
    """Return the steps of a plan, as programs have them.

    Raises:
        UnreadableStepError: an action or a thing has no counterpart, or a field is missing.
    """
    high, low = plan.get("high_pddl"), plan.get("low_actions", [])
    if not isinstance(high, list) or not isinstance(low, list):
        raise UnreadableStepError(Code.BAD_JSON, "a plan without `high_pddl`", "a list of high-level actions")
    writer = _Writer(knowledge, _opened(low))
    return list(writer.steps(high))


def _opened(low: Sequence[Any]) -> dict[Any, list[str]]:
    """Return the names of the low-level actions of each high-level action, by its index."""
    found: dict[Any, list[str]] = {}
    for each in low:
        action = each.get("api_action") if isinstance(each, dict) else None
        if isinstance(action, dict) and isinstance(each.get("high_idx"), int):
            found.setdefault(each["high_idx"], []).append(str(action.get("action")))
    return found


class _Writer:
    """A writer of steps that numbers the things of each class in the order in which they are used."""

    def __init__(self, knowledge: Knowledge, low: Mapping[Any, list[str]]) -> None:
        self.knowledge = knowledge
        self.low = low
        self.numbers: dict[str, dict[str, int]] = {}
        self.open: set[str] = set()
        self.held = ""

    def steps(self, high: Sequence[Any]) -> Iterator[str]:
        """Yield the steps of high-level actions."""
        for number, each in enumerate(high):
            action = each.get("discrete_action") if isinstance(each, dict) else None
            planned = each.get("planner_action") if isinstance(each, dict) else None
            if (
                not isinstance(action, dict)
                or not isinstance(planned, dict)
                or not isinstance(action.get("args"), list)
            ):
                raise UnreadableStepError(Code.BAD_JSON, f"action {number + 1} of the plan has no `discrete_action`")
            name, args = str(action.get("action")), [str(arg) for arg in action["args"]]
            low = self.low.get(each.get("high_idx"), [])
            if name == "GotoLocation":
                yield from self._walk(args, high[number + 1 :])
            elif name in WRITERS and args:
                yield from WRITERS[name](self, args, planned, low)
            elif name not in ("NoOp", "End"):
                raise UnreadableStepError(Code.UNKNOWN_ACTION, f"action {number + 1} of the plan, `{name[:40]}`",
                                          f"known are {', '.join(WRITERS)}")  # fmt: skip

    def _walk(self, args: Sequence[str], later: Sequence[Any]) -> Iterator[str]:
        """Yield a walk to the receptacle or thing that the next action is about; its number is the one used there."""
        if args and args[0]:
            yield f"[Walk] {self.thing(args[0], _used_next(args[0], later))}"

    def thing(self, name: str, key: str = "") -> str:
        """Return a thing of a plan as steps name it, `<fridge> (1)`.

        Args:
            name: its type.
            key: distinguishes things of one class.
        """
        class_name = class_of(name, self.knowledge)
        if not class_name:
            raise UnreadableStepError(Code.UNKNOWN_OBJECT, f"no class of ours is a `{name[:40]}`",
                                      "`pipelines/readers/alfred_classes.csv` has the classes of others")  # fmt: skip
        known = self.numbers.setdefault(class_name, {})
        number = known.setdefault(key, len(known) + 1) if key or not known else next(reversed(known.values()))
        return f"<{class_name}> ({number})"

    def pick_up(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of picking something up, from something closed too."""
        self.held = self.thing(args[0], object_key(planned))
        yield from self._around(planned, low, [f"[Grab] {self.held}"])

    def put(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of putting something on or in a receptacle."""
        if len(args) < 2:
            raise UnreadableStepError(Code.BAD_JSON, "`PutObject` without its receptacle")
        one, other = self.thing(args[0], object_key(planned)), self.thing(args[1], receptacle_key(planned))
        inside = "OpenObject" in low or self._holds(args[1])
        yield from self._around(planned, low, [f"[{'PutIn' if inside else 'PutBack'}] {one} {other}"])

    def _holds(self, name: str) -> bool:
        """Return whether things are put in a receptacle that needs no opening, a sink or a cup, and not on it."""
        class_name = class_of(name, self.knowledge)
        inner = self.knowledge.has(class_name, "RECIPIENT") or self.knowledge.has(class_name, "CONTAINERS")
        return inner and not self.knowledge.has(class_name, "SURFACES")

    def _around(self, planned: Mapping[str, Any], low: Sequence[str], steps: Sequence[str]) -> Iterator[str]:
        """Yield steps between the opening and the closing of their receptacle."""
        holder, touched = receptacle_type(planned), {"OpenObject", "CloseObject"} & set(low)
        named = self.thing(holder, receptacle_key(planned)) if holder and touched else ""
        opens = bool(named) and self.knowledge.has(class_of(holder, self.knowledge), "CAN_OPEN")
        if opens and "OpenObject" in low and named not in self.open:
            self.open.add(named)
            yield f"[Open] {named}"
        yield from steps
        if opens and "CloseObject" in low and named in self.open:
            self.open.remove(named)
            yield f"[Close] {named}"

    def toggle(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the step of switching a lamp on."""
        yield f"[SwitchOn] {self.thing(args[0], object_key(planned))}"

    def cut(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of cutting something."""
        one = self.thing(args[0], object_key(planned))
        yield from self._around(planned, low, [f"[Walk] {one}", f"[Cut] {one}"])

    def clean(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of rinsing something under a tap: the thing that is held, where the plan names none."""
        one = self.thing(args[0]) if args[0] or not self.held else self.held
        yield from (f"[Walk] {self.thing('faucet')}", f"[SwitchOn] {self.thing('faucet')}")
        yield from (f"[Wash] {one}", f"[SwitchOff] {self.thing('faucet')}")

    def heat(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of heating something in a microwave."""
        one, oven = self.thing(args[0]), self.thing("microwave")
        yield from (
            f"[Walk] {oven}",
            f"[Open] {oven}",
            f"[PutIn] {one} {oven}",
            f"[Close] {oven}",
            f"[SwitchOn] {oven}",
        )
        yield from self._waits("microwave_heats")
        yield from (f"[SwitchOff] {oven}", f"[Open] {oven}", f"[Grab] {one}", f"[Close] {oven}")

    def cool(self, args: Sequence[str], planned: Mapping[str, Any], low: Sequence[str]) -> Iterator[str]:
        """Yield the steps of cooling something in a fridge."""
        one, fridge = self.thing(args[0]), self.thing("fridge")
        yield from (f"[Walk] {fridge}", f"[Open] {fridge}", f"[PutIn] {one} {fridge}", f"[Close] {fridge}")
        yield from self._waits("fridge_cools")
        yield from (f"[Open] {fridge}", f"[Grab] {one}", f"[Close] {fridge}")

    def _waits(self, process: str) -> list[str]:
        """Return a wait for each tick that a process takes."""
        return ["[Wait]"] * self.knowledge.processes[process].after


WRITERS = {
    "PickupObject": _Writer.pick_up,
    "PutObject": _Writer.put,
    "ToggleObject": _Writer.toggle,
    "SliceObject": _Writer.cut,
    "CleanObject": _Writer.clean,
    "HeatObject": _Writer.heat,
    "CoolObject": _Writer.cool,
}
"""The steps of each high-level action."""


def _used_next(name: str, later: Sequence[Any]) -> str:
    """Return the key of the thing that is walked to: the object or receptacle of the next action."""
    for each in later:
        planned = each.get("planner_action") if isinstance(each, dict) else None
        if not isinstance(planned, dict) or planned.get("action") == "GotoLocation":
            return ""
        if key_of(object_key(planned)).startswith(key_of(name)):
            return object_key(planned)
        holder = key_of(receptacle_type(planned))
        if holder and (holder.startswith(key_of(name)) or key_of(name).startswith(holder)):
            return receptacle_key(planned)
        return ""
    return ""


def object_key(planned: Mapping[str, Any]) -> str:
    """Return the key of an object, its type and first place; a slice is the thing that was cut."""
    return re.sub(r"\|[A-Za-z]+Sliced_\d+$", "", str(planned.get("objectId", "")))


def receptacle_type(planned: Mapping[str, Any]) -> str:
    """Return the type of the receptacle of an action; "" where it has none."""
    given = planned.get("coordinateReceptacleObjectId")
    return str(given[0]) if isinstance(given, list) and given else ""


def receptacle_key(planned: Mapping[str, Any]) -> str:
    """Return the key of a receptacle, its type and place."""
    given = planned.get("coordinateReceptacleObjectId")
    return f"{given[0]}|{given[1:]}" if isinstance(given, list) and given else ""


def class_of(name: str, knowledge: Knowledge) -> str:
    """Return the class of an object type of ALFRED; "" where there is none."""
    key = key_of(name)
    named = _classes().get(key, key)
    known = knowledge.object_class(named)
    return known.name if known is not None else ""


@cache
def _classes() -> Mapping[str, str]:
    text = (files("hearth.pipelines.readers") / "alfred_classes.csv").read_text("utf-8")
    rows = csv.DictReader(line for line in text.splitlines() if not line.startswith("#"))
    return {row["name"]: row["class"] for row in rows}
