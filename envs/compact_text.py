"""An agent's observation in a few hundred characters, as the protocol hearth-text/1 has it.

Everything here depends on the seen nodes alone, and no name changes from tick to tick.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import cached_property, lru_cache

from hearth.envs.json_observations import named_nodes, seen_failure, seen_goal
from hearth.envs.text_agent import plain
from hearth.envs.text_layout import (
    Layout,
    Placement,
    Stated,
    class_words,
    layout,
    placement,
    printable,
    runs,
    said_rows,
    stated,
)
from hearth.envs.text_protocol_settings import Protocol
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failure_words import sentence
from hearth.schemas.goals import Goal
from hearth.schemas.literals import Literal, Name
from hearth.simulation.actions.legal import Legal
from hearth.simulation.actions.registry import EVERY
from hearth.simulation.observation.views import Pose, View
from hearth.simulation.world.bits import indices
from hearth.simulation.world.home import Home

FULL, WANTED, COUNTED, SUMMED = range(4)
"""Degrees of detail; each leaves out more to keep to the length.

Nothing; commands about small things that are not wanted; the numbers of those things, and commands about furniture;
their classes, so that a place only says how many they are, and commands about furniture but those that open it.
"""

CUT = " ..."
"""The end of a text that was cut."""

OUT_OF_REACH = "The goal can't be reached any longer"
"""Said below the goal where a ban of it was broken."""

IN_SHORT = " In short: "
"""Between a person's own words and the instruction that says the same."""

MOST_GOAL = 300
"""Characters of the goal's words."""

MOST_TEXTS = 64
"""Texts that are kept about things at the same places."""

MOST_PLACES = 4_096
"""Texts of single places that are kept for a home."""


def wanted_nodes(goal: Goal, home: Home, seen: int) -> int:
    """Return the nodes that a goal names among those that are seen."""
    fixed, names = _wanted_terms(goal, home)
    found = fixed
    for sets in names:
        found |= next((some for each in sets if (some := each & seen)), 0)
    return found & seen & ~home.characters


@lru_cache(maxsize=256)
def _wanted_terms(goal: Goal, home: Home) -> tuple[int, tuple[tuple[int, ...], ...]]:
    """Return the nodes that a goal names by id, and for each class the sets of which the first that is seen counts."""
    fixed, names = 0, set[tuple[int, ...]]()
    for literal, _ in goal.literals():
        for term in literal.terms:
            if isinstance(term, int):
                fixed |= 1 << home.index[term] if term in home.index else 0
            else:
                names.add(named_nodes(term, home))
    return fixed, tuple(names)


def compact(
    view: View,
    legal: Legal,
    goal: Goal,
    protocol: Protocol,
    task: str = "",
    last: str = "",
    *,
    stopped: bool = False,
    broken: Sequence[str] = (),
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
        broken: the bans of the goal that were broken, which puts it out of reach.
    """
    writer = _Writer(view, legal, goal, protocol, stopped)
    head = [writer.goal(task), writer.me(), *writer.others()]
    if broken:
        head.insert(1, _cut(f"Broken: {printable('; '.join(broken))}. {OUT_OF_REACH}.", protocol.most_last))
    if note := last or writer.last():
        head.append(f"Last: {_cut(printable(note), protocol.most_last)}")
    return _cut(_within(writer, "\n".join(head), protocol.usual), protocol.most)


def _within(writer: _Writer, head: str, usual: int) -> str:
    """Return the text with the most detail that keeps to the usual length; the shortest where none does."""
    here = writer.here(FULL)
    if len(head) + len(here) < usual:
        for detail in (FULL, WANTED):
            if listed := writer.commands(detail, usual - len(head) - len(here) - 2):
                return f"{head}\n{here}\n{listed}"
    here = writer.here(COUNTED)
    if listed := writer.commands(COUNTED, usual - len(head) - len(here) - 2):
        return f"{head}\n{here}\n{listed}"
    return f"{head}\n{writer.here(SUMMED)}\n{writer.commands(SUMMED)}"


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
        self.held = 0
        for pose in (view.me, *view.others):
            for node in (*pose.holding, *pose.wearing):
                self.held |= 1 << self.home.index[node]
        self.keep = ~self.layout.built & (~self.layout.fixtures | self.wanted)
        self.kept = view.mask & self.keep
        rows = said_rows(self.world, self.kept, self.layout)
        self.stated = stated(self.layout, rows, self.home.doors & self.kept, view.me.room)
        self.placement = placement(self.world, self.kept & ~self.held, self.layout)

    def _name(self, node: int) -> str:
        return self.layout.names[self.home.index[node]]

    def _names(self, nodes: Iterable[int]) -> str:
        return ", ".join(map(self._name, nodes)) or "nothing"

    def goal(self, task: str) -> str:
        """Return the line about the goal, with the parts of it that are seen."""
        seen = list(seen_goal(self.wanted_goal, self.view))
        wanted = tuple([each.wanted for each in seen])
        said, end = _goal_words(task, self.wanted_goal, wanted, self.layout, self.protocol)
        counts = ", ".join([f"{each.seen}/{each.wanted}" for each in seen if each.seen is not None])
        return f"Goal: {said}{end}" + (f" You see {counts} done." if counts else "")

    def me(self) -> str:
        """Return the line about oneself and the rooms."""
        me = self.view.me
        where = f"{me.posture} in {self._name(me.room)}" if me.room is not None else me.posture
        worn = f", wearing {self._names(me.wearing)}" if me.wearing else ""
        rooms = _other_rooms(self.layout, me.room)
        return f"You: {where}, holding {self._names(me.holding)}{worn}. Other rooms: {rooms}."

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
        last = f", tried {printable(said_step(plain(pose.last.instruction)))}" if pose.last is not None else ""
        return f"Agent {pose.agent}: here, holding {self._names(pose.holding)}{last}."

    def here(self, detail: int) -> str:
        """Return the seen things, those on and in others behind these."""
        counted = 0 if detail < COUNTED else self.kept & ~(self.wanted | self.layout.large | self.home.doors)
        texts, key = self.placement.texts, (self.stated, counted, detail == SUMMED)
        found = texts.get(key)
        if found is None:
            said = _counted if detail < SUMMED else _summed
            places = _PlacesText(self.layout, self.placement, self.stated, counted, said)
            if len(texts) >= MOST_TEXTS:
                texts.clear()
            found = texts[key] = f"Here: {places.group(self.placement.top) or 'nothing'}"
        return found

    def commands(self, detail: int, most: int | None = None) -> str:
        """Return the sensible commands, without walks; empty where they have more characters than `most`."""
        offered, opened, opens = self._offered(detail), 0, ""
        if detail == SUMMED:
            opened, opens = self._offered(COUNTED), _opening(self.home.knowledge)
        found, end = "Do: Walk <room or thing>", "; wait"
        for action, masks in self._possible:
            line = self._command(action, masks, opened if action == opens else offered, detail) if masks else action
            if line:
                found = f"{found}; {line}"
            if most is not None and len(found) + len(end) > most:
                return ""
        return f"{found}{end}" if most is None or len(found) + len(end) <= most else ""

    def _offered(self, detail: int) -> int:
        """Return the nodes that commands are listed about."""
        if detail == FULL:
            return self.keep
        large = self.layout.large
        some = large if detail == WANTED else self.layout.hollow & large if detail == COUNTED else 0
        return self.keep & (self.wanted | some | self.held)

    @cached_property
    def _possible(self) -> list[tuple[str, tuple[int, ...]]]:
        """Actions that `Do:` may list and that can be done; the masks of walks, which are dear, are not asked for."""
        asked, found = self.legal.asked, self.legal.masks
        listed = _listed_actions(self.home.knowledge, self.protocol)
        return [(each, masks) for each in listed if each in asked and (masks := found.get(each)) is not None]

    def _command(self, action: str, masks: tuple[int, ...], offered: int, detail: int) -> str:
        first, place = masks[0] & offered, self.layout
        if not first:
            return ""
        if len(masks) == 1:
            if action == "Grab":
                first &= ~(place.large | self.held)
            return f"{action} {_by_class(self.home, first)}" if first else ""
        places = masks[1] & offered & ((place.large & ~place.not_targets) | self.wanted)
        if action == "PutIn":
            places &= place.opened
        if detail > WANTED:
            places &= self.wanted or places
        return _with_places(action, first, places, place)


class _PlacesText:
    """The words for things by their places."""

    def __init__(
        self, place: Layout, placed: Placement, states: Stated, counted: int, said: Callable[[Home, int], str]
    ) -> None:
        self.layout, self.home, self.placement = place, place.home, placed
        self.states, self.counted, self.said = states, counted, said

    def group(self, things: int) -> str:
        """Return some things: those of a class and state together, then those that others are on or in."""
        if not things:
            return ""
        counted = self.counted
        places = things & self.placement.places
        stated = things & self.states.nodes & ~counted & ~places
        bare = things & ~places & ~stated
        found = [_by_class(self.home, bare & ~counted, ", ")] if bare & ~counted else []
        if bare & counted:
            found.append(self.said(self.home, bare & counted))
        if stated:
            groups: dict[tuple[str, str], int] = {}
            for i in indices(stated):
                key = self.home.classes[i], self.states.words[i]
                groups[key] = groups.get(key, 0) | 1 << i
            found += [f"{_by_class(self.home, nodes, ', ')}{state}" for (_, state), nodes in groups.items()]
        if places:
            found += [self._with_things(i) for i in indices(places)]
        return ", ".join(found)

    def _with_things(self, i: int) -> str:
        """Return a place with the things on it and in it; kept where none of them is a place itself."""
        on, inside = self.placement.on.get(i, 0), self.placement.inside.get(i, 0)
        both = on | inside
        if both & self.placement.places:
            return self._written(i, on, inside)
        words, texts = self.states.words, self.layout.texts
        both |= 1 << i
        stated = both & self.states.nodes
        states = tuple([words[at] for at in indices(stated)]) if stated else ()
        key = i, on, inside, stated, states, both & self.counted, self.said
        found = texts.get(key)
        if found is None:
            if len(texts) >= MOST_PLACES:
                texts.clear()
            found = texts[key] = self._written(i, on, inside)
        return found

    def _written(self, i: int, on_it: int, in_it: int) -> str:
        on, inside = self.group(on_it), self.group(in_it)
        both = f"{on}, in it {inside}" if on and inside else f"in it {inside}" if inside else on
        state = "" if self.counted >> i & 1 else self.states.words.get(i, "")
        return f"{self.layout.names[i]}{state} [{both}]"


@lru_cache(maxsize=1024)
def _goal_words(task: str, goal: Goal, wanted: tuple[int, ...], place: Layout, protocol: Protocol) -> tuple[str, str]:
    """Return the words of a goal, and the stop that they lack."""
    counted = zip(goal.counts, wanted, strict=False)  # those of the parts follow
    literals = (_literal(literal, number, place, protocol) for (literal, _), number in counted)
    said = printable(task) or "; ".join((*literals, *map(str, goal.parts)))
    return _shortened(said), "" if said.endswith((".", "!", "?")) else "."


def _literal(literal: Literal[Name], wanted: int, place: Layout, protocol: Protocol) -> str:
    """Return a counted literal in words, where the protocol has a phrase; as goals write it otherwise."""
    phrases = protocol.goals
    if literal.negated or literal.name not in phrases or len(literal.terms) != 2:
        return str(literal) + (f": {wanted}" if wanted > 1 else "")
    subject, target = (_term(term, place) for term in literal.terms)
    count = f"{wanted} " if wanted > 1 else ""
    return phrases[literal.name].format(count=count, subject=subject, target=target)


def _term(term: Name, place: Layout) -> str:
    """Return what a goal names, as observations name it; everybody may know which furniture a goal is about."""
    known = place.home.index
    return place.names[known[term]] if isinstance(term, int) and term in known else str(term)


@lru_cache(maxsize=1024)
def _other_rooms(place: Layout, room: int | None) -> str:
    """Return the rooms but one."""
    home = place.home
    return ", ".join(place.names[i] for i in indices(home.rooms) if home.ids[i] != room) or "none"


@lru_cache(maxsize=4096)
def _with_places(action: str, first: int, places: int, place: Layout) -> str:
    """Return the commands of an action of two things."""
    return "; ".join(
        f"{action} {place.names[i]}, {_by_class(place.home, places & ~(1 << i))}"
        for i in indices(first)
        if places & ~(1 << i)
    )


@lru_cache(maxsize=64)
def _opening(knowledge: Knowledge) -> str:
    """Return the action that opens things."""
    return knowledge.achiever("OPEN")


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
    return between.join([f"{class_words(name)} {runs(ids)}" for name, ids in groups.items()])


@lru_cache(maxsize=65_536)
def _counted(home: Home, nodes: int) -> str:
    """Return the classes of some nodes, each with how many there are."""
    counts: dict[str, int] = {}
    for i in indices(nodes):
        name = class_words(home.classes[i])
        counts[name] = counts.get(name, 0) + 1
    return ", ".join([f"{name} x{number}" if number > 1 else name for name, number in counts.items()])


def _summed(home: Home, nodes: int) -> str:
    """Return how many some nodes are; the class of one alone."""
    number = nodes.bit_count()
    return f"{number} things" if number > 1 else _counted(home, nodes)


def said_step(text: str) -> str:
    """Return an instruction as texts have it: `Walktowards` is said `Walk`."""
    return text.replace("Walktowards", "Walk", 1) if text.startswith("Walktowards") else text
