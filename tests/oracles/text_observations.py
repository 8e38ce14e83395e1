"""The plain writer of hearth-text/1: each observation from its world alone, node by node, with nothing kept.

`envs/compact_text.py` writes the same bytes from what worlds share.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

from hearth.envs.json_observations import SeenLiteral, seen_failure, seen_goal, seen_instances
from hearth.envs.text_agent import USUAL, plain
from hearth.envs.text_protocol_settings import Protocol
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failure_words import sentence
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Name
from hearth.schemas.vocabulary import CHARACTER_CATEGORY, STATE_ID
from hearth.simulation.actions.legal import Legal
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.motion.ground import UNTOUCHED
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home

FURNISHING = frozenset({"Furniture", "Appliances"})
"""Categories of things that others are put on or in, and that nobody carries."""

FULL, WANTED, COUNTED, SUMMED = range(4)
"""Degrees of detail; each leaves out more to keep to the length.

Nothing; commands about small things that are not wanted; the numbers of those things, and commands about furniture;
their classes, so that a place only says how many they are, and commands about furniture but those that open it.
"""

CUT = " ..."
"""The end of a text that was cut."""

IN_SHORT = " In short: "
"""Between a person's own words and the instruction that says the same."""

MOST_GOAL = 300
"""Characters of the goal's words."""


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


def wanted_nodes(goal: Goal, home: Home, seen: int) -> int:
    """Return the nodes that a goal names among those that are seen."""
    found = 0
    for literal, _ in goal.literals():
        for term in literal.terms:
            if isinstance(term, int):
                found |= 1 << home.index[term] if term in home.index else 0
            else:
                found |= seen_instances(term, home, seen)
    return found & seen & ~home.characters


def compact(
    view: View, legal: Legal, goal: Goal, protocol: Protocol, task: str = "", last: str = "", *, stopped: bool = False
) -> str:
    """Return an observation of at most `protocol.most` characters.

    Args:
        view: the agent's.
        legal: its possible instructions.
        goal: its goal.
        protocol: the words and limits.
        task: the goal as somebody says it; put into words where empty.
        last: a note about the last command, instead of the view's own.
        stopped: whether the last command, a walk, ended early because something wanted came into sight.
    """
    writer = _Writer(view, legal, goal, protocol, stopped)
    head = [writer.goal(task), writer.me(), *writer.others()]
    if note := last or writer.last():
        head.append(f"Last: {_cut(note, protocol.most_last)}")
    return _cut(_within(writer, "\n".join(head), protocol.usual), protocol.most)


def _within(writer: _Writer, head: str, usual: int) -> str:
    """Return the text with the most detail that keeps to the usual length; the shortest where none does."""
    here = writer.here(FULL)
    if len(head) + len(here) < usual:
        for detail in (FULL, WANTED):
            text = f"{head}\n{here}\n{writer.commands(detail)}"
            if len(text) <= usual:
                return text
    text = f"{head}\n{writer.here(COUNTED)}\n{writer.commands(COUNTED)}"
    return text if len(text) <= usual else f"{head}\n{writer.here(SUMMED)}\n{writer.commands(SUMMED)}"


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else text[: most - len(CUT)] + CUT


def _shortened(said: str) -> str:
    """Return the words of a goal; where they are too long, a person's own words are cut, and not their short form."""
    words, mark, short = said.rpartition(IN_SHORT)
    room = MOST_GOAL - len(mark) - len(short)
    return f"{_cut(words, room)}{mark}{short}" if mark and room > len(CUT) else _cut(short if mark else said, MOST_GOAL)


class _Writer:
    """The lines of one observation."""

    def __init__(self, view: View, legal: Legal, goal: Goal, protocol: Protocol, stopped: bool) -> None:
        self.view, self.legal, self.wanted_goal, self.protocol = view, legal, goal, protocol
        self.stopped = stopped
        self.world, self.home = view.world, view.world.home
        self.layout = layout(self.home, protocol)
        self.wanted = wanted_nodes(goal, self.home, view.mask)
        poses = (view.me, *view.others)
        self.held = sum(1 << self.home.index[node] for pose in poses for node in {*pose.holding, *pose.wearing})
        self.kept = view.mask & ~self.layout.built & (~self.layout.fixtures | self.wanted)
        self.states = self._states()
        self.stated = sum(1 << i for i in self.states)
        self._place()

    def _name(self, node: int) -> str:
        return self.layout.names[self.home.index[node]]

    def _names(self, nodes: Iterable[int]) -> str:
        return ", ".join(map(self._name, nodes)) or "nothing"

    def goal(self, task: str) -> str:
        """Return the line about the goal, with the parts of it that are seen."""
        seen = list(seen_goal(self.wanted_goal, self.view))
        counted = seen[: len(self.wanted_goal.counts)]
        said = printable(task) or "; ".join([*map(self._said, counted), *map(str, self.wanted_goal.parts)])
        counts = ", ".join(f"{each.seen}/{each.wanted}" for each in seen if each.seen is not None)
        line = f"Goal: {_shortened(said)}{'' if said.endswith(('.', '!', '?')) else '.'}"
        return f"{line} You see {counts} done." if counts else line

    def _said(self, each: SeenLiteral) -> str:
        """Return a counted literal in words, where the protocol has a phrase; as goals write it otherwise."""
        literal, phrases = each.literal, self.protocol.goals
        if literal.negated or literal.name not in phrases or len(literal.terms) != 2:
            return str(literal) + (f": {each.wanted}" if each.wanted > 1 else "")
        subject, target = (self._term(term) for term in literal.terms)
        count = f"{each.wanted} " if each.wanted > 1 else ""
        return phrases[literal.name].format(count=count, subject=subject, target=target)

    def _term(self, term: Name) -> str:
        """Return what a goal names, as observations name it; everybody may know which furniture a goal is about."""
        return self._name(term) if isinstance(term, int) and term in self.home.index else str(term)

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
        if self.stopped:
            return f"{said_step(plain(last.instruction))} - on the way, for something wanted is in sight."
        failed = "" if last.failure is None else f"FAILED: {sentence(seen_failure(last.failure, self.view))}"
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
        counted = 0 if detail < COUNTED else self.kept & ~(self.wanted | self.layout.large | self.home.doors)
        said = _counted if detail < SUMMED else _summed
        return f"Here: {self._group(self.top, counted, said) or 'nothing'}"

    def _place(self) -> None:
        """Find the seen things that are on and in nothing seen, and the others by their place."""
        world, shown, opened = self.world, self.kept & ~self.held, self.layout.opened
        self.top = self.places = 0
        self.on: dict[int, int] = {}
        self.inside: dict[int, int] = {}
        for i in indices(shown):
            inside, on = edge_rows.inside(world, i) & shown, edge_rows.on(world, i) & shown
            place, bit = inside or on, 1 << i
            if not place:
                self.top |= bit
                continue
            at = (place & -place).bit_length() - 1
            self.places |= 1 << at
            below = self.inside if inside and opened >> at & 1 else self.on
            below[at] = below.get(at, 0) | bit

    def _group(self, things: int, counted: int, said: Callable[[Home, int], str]) -> str:
        """Return some things: those of a class and state together, then those that others are on or in."""
        places = things & self.places
        stated = things & self.stated & ~counted & ~places
        bare = things & ~places & ~stated
        found = [_by_class(self.home, bare & ~counted, ", ")] if bare & ~counted else []
        if bare & counted:
            found.append(said(self.home, bare & counted))
        groups: dict[tuple[str, str], int] = {}
        for i in indices(stated):
            key = self.home.classes[i], self.states[i]
            groups[key] = groups.get(key, 0) | 1 << i
        found += [f"{_by_class(self.home, nodes, ', ')}{state}" for (_, state), nodes in groups.items()]
        found += [self._with_things(i, counted, said) for i in indices(places)]
        return ", ".join(found)

    def _with_things(self, i: int, counted: int, said: Callable[[Home, int], str]) -> str:
        on = self._group(self.on.get(i, 0), counted, said)
        inside = self._group(self.inside.get(i, 0), counted, said)
        both = f"{on}, in it {inside}" if on and inside else f"in it {inside}" if inside else on
        state = "" if counted >> i & 1 else self.states.get(i, "")
        return f"{self.layout.names[i]}{state} [{both}]"

    def commands(self, detail: int) -> str:
        """Return the sensible commands, without walks."""
        lines = ["Walk <room or thing>"]
        for action, masks in self._possible:
            if line := self._command(action, masks, detail):
                lines.append(line)
        return f"Do: {'; '.join([*lines, 'wait'])}"

    @cached_property
    def _possible(self) -> list[tuple[str, tuple[int, ...]]]:
        """Actions that `Do:` may list and that can be done; the masks of walks, which are dear, are not asked for."""
        asked, found = self.legal.asked, self.legal.masks
        listed = _listed_actions(self.home.knowledge, self.protocol)
        return [(each, masks) for each in listed if each in asked and (masks := found.get(each)) is not None]

    def _command(self, action: str, masks: tuple[int, ...], detail: int) -> str:
        keep = ~self.layout.built & (~self.layout.fixtures | self.wanted)
        if detail == WANTED:
            keep &= self.wanted | self.layout.large | self.held
        elif detail == SUMMED and action != self.home.knowledge.achiever("OPEN"):
            keep &= self.wanted | self.held
        elif detail > WANTED:
            keep &= self.wanted | self.layout.hollow & self.layout.large | self.held
        if not masks:
            return action
        first = masks[0] & keep
        if len(masks) == 1:
            if action == "Grab":
                first &= ~(self.layout.large | self.held)
            return f"{action} {_by_class(self.home, first)}" if first else ""
        places = masks[1] & keep & ((self.layout.large & ~self.layout.not_targets) | self.wanted)
        if action == "PutIn":
            places &= self.layout.opened
        if detail > WANTED:
            places &= self.wanted or places
        found = [
            f"{action} {self.layout.names[i]}, {_by_class(self.home, places & ~(1 << i))}"
            for i in indices(first) if places & ~(1 << i)
        ]  # fmt: skip
        return "; ".join(found)


@lru_cache(maxsize=64)
def _listed_actions(knowledge: Knowledge, protocol: Protocol) -> tuple[str, ...]:
    """Return the actions that `Do:` may list."""
    return tuple(sorted(name for name in EVERY if name in knowledge.actions and name not in protocol.hidden))


@lru_cache(maxsize=65_536)
def _by_class(home: Home, nodes: int, between: str = " | ") -> str:
    """Return the classes of some nodes, each with its numbers."""
    groups: dict[str, list[int]] = {}
    for i in indices(nodes):
        groups.setdefault(home.classes[i], []).append(home.ids[i])
    return between.join(f"{name} {_runs(ids)}" for name, ids in groups.items())


@lru_cache(maxsize=65_536)
def _counted(home: Home, nodes: int) -> str:
    """Return the classes of some nodes, each with how many there are."""
    counts = Counter(home.classes[i] for i in indices(nodes))
    return ", ".join(f"{name} x{number}" if number > 1 else name for name, number in counts.items())


def _summed(home: Home, nodes: int) -> str:
    """Return how many some nodes are; the class of one alone."""
    number = nodes.bit_count()
    return f"{number} things" if number > 1 else _counted(home, nodes)


def _runs(ids: Iterable[int]) -> str:
    """Return ascending numbers, three and more in a row as the first and the last: `66-69 74`."""
    runs: list[list[int]] = []
    for number in ids:
        if runs and number == runs[-1][-1] + 1:
            runs[-1].append(number)
        else:
            runs.append([number])
    return " ".join(f"{run[0]}-{run[-1]}" if len(run) > 2 else " ".join(map(str, run)) for run in runs)


def printable(text: str) -> str:
    """Return a text on one line, with `?` for characters that a terminal would obey."""
    return "".join(each if each.isprintable() else "?" for each in " ".join(text.split()))


def said_step(text: str) -> str:
    """Return an instruction as texts have it: `Walktowards` is said `Walk`."""
    return text.replace("Walktowards", "Walk", 1) if text.startswith("Walktowards") else text
