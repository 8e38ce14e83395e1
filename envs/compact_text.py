"""An agent's observation in a few hundred characters, as the protocol hearth-text/1 has it.

Everything here depends on the seen nodes alone, and no name changes from tick to tick.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache

from hearth.envs.json_observations import SeenLiteral, seen_failure, seen_goal, seen_instances
from hearth.envs.text_protocol import USUAL, plain
from hearth.envs.text_protocols import Protocol
from hearth.schemas.goals import Goal
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, STATE_ID
from hearth.simulation.actions.legal import Legal
from hearth.simulation.motion.ground import UNTOUCHED
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world import rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home

FURNISHING = frozenset({"Furniture", "Appliances"})
"""Categories of things that others are put on or in, and that nobody carries."""

FULL, WANTED, COUNTED = range(3)
"""Degrees of detail, by what is left out to keep to the length.

Nothing; commands about small things that are not wanted; the numbers of those things, and commands about furniture.
"""

CUT = " ..."
"""The end of a text that was cut."""


@dataclass(frozen=True)
class Layout:
    """Sets of a home's nodes that never change.

    Attributes:
        names: of each node, as texts have it.
        built: rooms, walls, floors, characters.
        fixtures: nodes that are left out unless they are wanted.
        large: furniture and appliances.
        not_targets: nodes that are not offered to put things on.
        hollow: nodes that things are put in.
        opened: nodes that can be opened.
    """

    names: tuple[str, ...]
    built: int
    fixtures: int
    large: int
    not_targets: int
    hollow: int
    opened: int


@lru_cache(maxsize=256)
def layout(home: Home, protocol: Protocol) -> Layout:
    """Return the sets of a home; made once."""
    known = home.knowledge
    found = dict.fromkeys(("built", "fixtures", "large", "not_targets", "hollow", "opened"), 0)
    for i, name in enumerate(home.classes):
        category, bit = home.node(i).category, 1 << i
        found["built"] |= bit * (category in UNTOUCHED or category == CHARACTER_CATEGORY)
        found["fixtures"] |= bit * (name in protocol.fixtures)
        found["large"] |= bit * (category in FURNISHING)
        found["not_targets"] |= bit * (name in protocol.not_targets)
        found["hollow"] |= bit * known.affords("PutIn", 1, name)
        found["opened"] |= bit * known.affords("Open", 0, name)
    return Layout(tuple(f"{name} {home.ids[i]}" for i, name in enumerate(home.classes)), **found)


def wanted_nodes(goal: Goal, view: View) -> int:
    """Return the seen nodes that a goal names."""
    home, found = view.world.home, 0
    for literal, _ in goal.literals():
        for term in literal.terms:
            if isinstance(term, int):
                found |= 1 << home.index[term] if term in home.index else 0
            else:
                found |= seen_instances(term, home, view.mask)
    return found & view.mask & ~home.characters


def compact(view: View, legal: Legal, goal: Goal, protocol: Protocol, task: str = "", last: str = "") -> str:
    """Return an observation of at most `protocol.most` characters.

    Args:
        view: the agent's.
        legal: its possible instructions.
        goal: its goal.
        protocol: the words and limits.
        task: the goal as somebody says it; put into words where empty.
        last: a note about the last command, instead of what the view has about it.
    """
    writer = _Writer(view, legal, goal, protocol)
    head = [writer.goal(task), writer.me(), *writer.others()]
    if note := last or writer.last():
        head.append(f"Last: {_cut(note, protocol.most_last)}")
    text = ""
    for detail in (FULL, WANTED, COUNTED):
        text = "\n".join((*head, writer.here(detail), writer.commands(detail)))
        if len(text) <= protocol.usual:
            break
    return _cut(text, protocol.most)


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else text[: most - len(CUT)] + CUT


class _Writer:
    """The lines of one observation."""

    def __init__(self, view: View, legal: Legal, goal: Goal, protocol: Protocol) -> None:
        self.view, self.legal, self.wanted_goal, self.protocol = view, legal, goal, protocol
        self.world, self.home = view.world, view.world.home
        self.layout = layout(self.home, protocol)
        self.wanted = wanted_nodes(goal, view)
        poses = (view.me, *view.others)
        self.held = sum(1 << self.home.index[node] for pose in poses for node in {*pose.holding, *pose.wearing})
        self.kept = view.mask & ~self.layout.built & (~self.layout.fixtures | self.wanted)
        self.states = self._states()
        self.tree = self._tree()

    def _name(self, node: int) -> str:
        return self.layout.names[self.home.index[node]]

    def _names(self, nodes: Iterable[int]) -> str:
        return ", ".join(map(self._name, nodes)) or "nothing"

    def goal(self, task: str) -> str:
        """Return the line about the goal, with what is seen of it."""
        seen = list(seen_goal(self.wanted_goal, self.view))
        said = task or "; ".join(said_literal(each, self.protocol.goals) for each in seen)
        counts = ", ".join(f"{each.seen}/{each.wanted}" for each in seen if each.seen is not None)
        return f"Goal: {_cut(' '.join(said.split()), 300)}{'' if said.endswith('.') else '.'} You see {counts} done."

    def me(self) -> str:
        """Return the line about oneself and the rooms."""
        me, home = self.view.me, self.home
        where = f"{me.posture} in {self._name(me.room)}" if me.room is not None else me.posture
        worn = f", wearing {self._names(me.wearing)}" if me.wearing else ""
        rooms = ", ".join(self.layout.names[i] for i in indices(home.rooms) if home.ids[i] != me.room)
        return f"You: {where}, holding {self._names(me.holding)}{worn}. Other rooms: {rooms or 'none'}."

    def last(self) -> str:
        """Return the last command and whether it could be done."""
        last = self.view.me.last
        if last is None:
            return ""
        failed = "" if last.failure is None else f"FAILED: {seen_failure(last.failure, self.view).message()}"
        return f"{said_step(plain(last.instruction))} - {failed or 'done'}."

    def others(self) -> Iterator[str]:
        """Yield the lines about the others that are seen."""
        yield from map(self._other, self.view.others)

    def _other(self, pose: Pose) -> str:
        last = f", tried {said_step(plain(pose.last.instruction))}" if pose.last is not None else ""
        return f"Agent {pose.agent}: here, holding {self._names(pose.holding)}{last}."

    def _states(self) -> dict[int, str]:
        """Return the unusual states of nodes, and where doors lead."""
        found: dict[int, list[str]] = {}
        for name, number in STATE_ID.items():
            if name in USUAL or name == "OFF":
                continue
            nodes = self.world.states[number] & self.kept
            for i in indices(nodes & (self.layout.hollow | self.home.doors) if name == "CLOSED" else nodes):
                found.setdefault(i, []).append(name.lower().replace("_", " "))
        for i in indices(self.home.doors & self.kept):
            rooms = indices(self.home.between[i] & self.home.rooms)
            found.setdefault(i, []).extend(
                f"to {self.home.classes[room]}" for room in rooms if self.home.ids[room] != self.view.me.room
            )
        return {i: f" ({', '.join(facts)})" for i, facts in found.items() if facts}

    def here(self, detail: int) -> str:
        """Return the seen things, those on and in others behind these."""
        top, below = self.tree
        return f"Here: {self._listed(top, below, detail) or 'nothing'}"

    def _tree(self) -> tuple[list[tuple[int, str]], dict[int, list[tuple[int, str]]]]:
        """Return the seen things that are on and in nothing seen, and the others by their place."""
        world, shown = self.world, self.kept & ~self.held
        below: dict[int, list[tuple[int, str]]] = {}
        top: list[tuple[int, str]] = []
        for i in indices(shown):
            inside, on = rows.inside(world, i) & shown, rows.on(world, i) & shown
            place = inside or on
            if not place:
                top.append((i, ""))
                continue
            at = (place & -place).bit_length() - 1
            how = "in" if inside and self.layout.opened >> at & 1 else ""
            below.setdefault(at, []).append((i, how))
        return top, below

    def _listed(self, things: list[tuple[int, str]], below: dict[int, list[tuple[int, str]]], detail: int) -> str:
        groups: dict[tuple[str, str, str], list[str]] = {}
        nested: list[tuple[str, str]] = []
        for i, how in things:
            counted = detail >= COUNTED and not (self.wanted | self.layout.large | self.home.doors) >> i & 1
            state, name = "" if counted else self.states.get(i, ""), self.layout.names[i]
            if i in below:
                nested.append((how, f"{name}{state} [{self._listed(below[i], below, detail)}]"))
            else:
                groups.setdefault((how, self.home.classes[i], state), []).append("" if counted else str(self.home.ids[i]))
        every = [(how, f"{name}{_numbers(some)}{state}") for (how, name, state), some in groups.items()] + nested
        inside = ", ".join(text for how, text in every if how)
        return ", ".join([*(text for how, text in every if not how), *([f"in it {inside}"] if inside else [])])

    def commands(self, detail: int) -> str:
        """Return the sensible commands, without walks."""
        lines = ["Walk <room or thing>"]
        for action in sorted(self.legal.masks.keys() - self.protocol.hidden):
            masks = self.legal.masks[action]
            if line := self._command(action, masks, detail):
                lines.append(line)
        return f"Do: {'; '.join([*lines, 'wait'])}"

    def _command(self, action: str, masks: tuple[int, ...], detail: int) -> str:
        keep = ~self.layout.built & (~self.layout.fixtures | self.wanted)
        if detail == WANTED:
            keep &= self.wanted | self.layout.large | self.held
        elif detail > WANTED:
            keep &= self.wanted | self.layout.hollow & self.layout.large | self.held
        if not masks:
            return action
        first = masks[0] & keep
        if len(masks) == 1:
            if action == "Grab":
                first &= ~(self.layout.large | self.held)
            return f"{action} {self._by_class(first)}" if first else ""
        places = masks[1] & keep & ((self.layout.large & ~self.layout.not_targets) | self.wanted)
        if action == "PutIn":
            places &= self.layout.opened
        if detail > WANTED:
            places &= self.wanted or places
        found = [
            f"{action} {self.layout.names[i]}, {self._by_class(places & ~(1 << i))}"
            for i in indices(first) if places & ~(1 << i)
        ]  # fmt: skip
        return "; ".join(found)

    def _by_class(self, nodes: int) -> str:
        groups: dict[str, list[str]] = {}
        for i in indices(nodes):
            groups.setdefault(self.home.classes[i], []).append(str(self.home.ids[i]))
        return " | ".join(f"{name} {_runs(ids)}" for name, ids in groups.items())


def _numbers(ids: list[str]) -> str:
    """Return the numbers of some things of a class; how many there are where they are only counted."""
    return f" {_runs(ids)}" if all(ids) else f" x{len(ids)}" if len(ids) > 1 else ""


def _runs(ids: Iterable[str]) -> str:
    """Return ascending numbers, three and more in a row as the first and the last: `66-69 74`."""
    runs: list[list[int]] = []
    for number in map(int, ids):
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return " ".join(f"{run[0]}-{run[-1]}" if len(run) > 2 else " ".join(map(str, run)) for run in runs)


def said_step(text: str) -> str:
    """Return an instruction as texts have it: `Walktowards` is said `Walk`."""
    return text.replace("Walktowards", "Walk", 1) if text.startswith("Walktowards") else text


def said_literal(each: SeenLiteral, phrases: Mapping[str, str]) -> str:
    """Return a counted literal in words, where the protocol has a phrase; as goals write it otherwise."""
    literal, terms = each.literal, [str(term).replace("_", " ") for term in each.literal.terms]
    if literal.negated or literal.name not in phrases or len(terms) != 2:
        return str(literal) + (f": {each.wanted}" if each.wanted > 1 else "")
    count = f"{each.wanted} " if each.wanted > 1 else ""
    return phrases[literal.name].format(count=count, subject=terms[0], target=terms[1])
