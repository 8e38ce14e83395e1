"""Agents that read and write text: language models, and people at a terminal.

Each tick they get the observation as lines of English and the numbered legal actions, and answer by a number or by
text.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from itertools import groupby

from hearth.agents.protocol import Choice, Resigned
from hearth.envs.agent_answers import SAYING, WAIT, Fault, Keep, by_number, by_words, keep_nothing, row
from hearth.envs.json_observations import seen_failure, seen_goal
from hearth.envs.seen_bans import SeenBans
from hearth.schemas.agent_messages import ASK
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import CHARACTER_CATEGORY
from hearth.simulation.actions.legal import Legal
from hearth.simulation.motion.ground import UNTOUCHED
from hearth.simulation.observation.views import LastAction, Pose, View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.bits import indices, mask_of
from hearth.simulation.world.node_states import with_states

MOST_LISTED = 40
"""Instructions of one action that are numbered in a text; others can be written."""

USUAL = frozenset({"CLEAN", "PLUGGED_IN"})
"""States that texts leave out."""

TALKING = f"Instead you may say something, which takes the tick: `{ASK}` what is wanted, or `{SAYING}`.\n"
"""Added to a prompt where messages are allowed."""

Ask = Callable[[str], str]
"""Gives the answer to a prompt: a language model, a person. EOFError ends the episode."""

_NUMBER = re.compile(r"#?([0-9]{1,9})[.)]?", re.ASCII)


class TextAgent:
    """An agent that is asked in text.

    Attributes:
        faults: answers that could not be used, in their order.

    Args:
        ask: answers a prompt.
        keep: gets a row for each tick: `tick`, `agent`, `prompt`, `answer`, `instruction`, `said`, `fault`.
        messages: whether it may say something instead of doing something.
    """

    def __init__(self, ask: Ask, keep: Keep = keep_nothing, messages: bool = False) -> None:
        self.ask, self.keep, self.messages = ask, keep, messages
        self.faults: list[Fault] = []
        self._goal: Goal | None = None
        self._bans: SeenBans | None = None

    def reset(self, observation: View, goal: Goal | None, seed: int) -> None:
        """Begin an episode; the seed is for the function that answers."""
        self.faults, self._goal = [], goal
        self._bans = None if goal is None else SeenBans(goal, observation)

    def act(self, observation: View, legal: Legal) -> Choice:
        """Ask once; an answer that can't be used is a fault, which the next prompt names."""
        options = list(legal)
        if self._bans is not None:
            self._bans.look(observation)
        asked = self._prompt(observation, options)
        try:
            answer = self.ask(asked)
        except EOFError:
            raise Resigned from None
        choice: Choice = None
        fault = None
        try:
            choice = understood(answer, observation, legal, options, self.messages)
        except HearthError as error:
            fault = Fault(observation.tick, error.diagnostics[0])
            self.faults.append(fault)
        self.keep({**row(observation, answer, choice, fault), "prompt": asked})
        return choice

    def _prompt(self, view: View, options: Sequence[Step]) -> str:
        said = "" if not self.faults or self.faults[-1].tick != view.tick - 1 else _refused(self.faults[-1])
        talk = TALKING if self.messages else ""
        return said + description(view, self._goal, self._bans) + "\n" + menu(options, view) + talk


def _refused(fault: Fault) -> str:
    remedy = f" ({fault.fault.suggestion})" if fault.fault.suggestion else ""
    return f"Your last answer was not used, and you waited. {fault.fault.code}: {fault.fault.message}{remedy}\n"


def understood(answer: str, view: View, legal: Legal, options: Sequence[Step], messages: bool = False) -> Choice:
    """Return the instruction that the last line of an answer means, or its message; None for `wait`.

    Raises:
        HearthError: EMPTY, NOT_TEXT, and those of `by_number` and `by_words`.
    """
    if not isinstance(answer, str):
        raise HearthError.of(Code.NOT_TEXT, f"an answer is {type(answer).__name__}, not text")
    lines = [line.strip() for line in answer.splitlines() if line.strip()]
    if not lines:
        raise HearthError.of(Code.EMPTY, "an empty answer", suggestion=f"a number, or `{WAIT}`")
    number = _NUMBER.fullmatch(lines[-1])
    return by_number(int(number[1]), options) if number else by_words(lines[-1], view, legal, messages)


def description(view: View, goal: Goal | None = None, bans: SeenBans | None = None) -> str:
    """Return an agent's observation as lines of English; numbers are node ids.

    States that are usual are left out (`USUAL`).

    Args:
        view: the observation.
        goal: of the agent.
        bans: of the goal, as the agent saw them kept or broken up to now.
    """
    me = view.me
    lines = [f"Tick {view.tick}. You are agent {view.agent}, {_where(me, view)}{_place(me)}."]
    lines.append(f"You hold {_things(me.holding, view)}." + _worn(me, view))
    if me.last is not None:
        lines.append(f"You last tried: {_tried(me.last, view)}")
    lines += _goal(goal, view) if goal is not None else ()
    lines += bans.lines() if bans is not None else ()
    lines += (_other(other, view) for other in view.others)
    lines += (f"Agent {number} said: {said}." for number, said in view.messages)
    return "\n".join((*lines, *_seen(view)))


def _where(pose: Pose, view: View) -> str:
    room = "nowhere" if pose.room is None else f"in {_name(pose.room, view)}"
    return f"{pose.posture} {room}" + (f", on {_things(pose.on, view)}" if pose.on else "")


def _place(pose: Pose) -> str:
    at = pose.place
    return "" if at is None else f" at ({at.x:.2f}, {at.z:.2f}) m, looking {at.yaw:.0f} degrees"


def _worn(pose: Pose, view: View) -> str:
    return f" You wear {_things(pose.wearing, view)}." if pose.wearing else ""


def _other(pose: Pose, view: View) -> str:
    last = f" It last tried: {_tried(pose.last, view)}" if pose.last is not None else ""
    return f"Agent {pose.agent} is here, {_where(pose, view)}, and holds {_things(pose.holding, view)}.{last}"


def _tried(last: LastAction, view: View) -> str:
    failure = f", which failed. {seen_failure(last.failure, view).message()}" if last.failure is not None else ""
    return f"{plain(last.instruction)}{failure}."


def _goal(goal: Goal, view: View) -> Iterator[str]:
    yield f"Goal: {goal}"
    for each in seen_goal(goal, view):
        if each.seen is not None:
            missing = max(0, each.wanted - each.seen)
            yield f"  {each.literal}: you see {each.seen} of {each.wanted}; " + (
                f"{missing} missing as far as you see" if missing else "done"
            )


def _seen(view: View) -> Iterator[str]:
    """Yield the rest: rooms, doors, and things by the place that they are on or in; walls and floors are left out."""
    home, world = view.world.home, view.world
    rooms = [_name(home.ids[i], view) for i in indices(home.rooms) if home.ids[i] != view.me.room]
    yield f"Other rooms: {', '.join(rooms) or 'none'}."
    held = {node for pose in (view.me, *view.others) for node in (*pose.holding, *pose.wearing)}
    by_place: dict[tuple[int, str], list[int]] = {}
    things = mask_of(i for i in indices(view.mask) if home.node(i).category not in UNTOUCHED)
    for i in indices(things):
        if home.ids[i] not in held:
            inside, on = edge_rows.inside(world, i) & things, edge_rows.on(world, i) & things
            place, how = (inside, "In") if inside else (on, "On") if on else (0, "Here")
            by_place.setdefault(((place & -place).bit_length() - 1, how), []).append(i)
    for (place, how), found in sorted(by_place.items()):
        where = "Here" if place < 0 else f"{how} {_name(home.ids[place], view)}"
        yield f"{where}: {', '.join(_with_states(i, view) for i in found)}."


def _with_states(i: int, view: View) -> str:
    home = view.world.home
    states = [s.lower() for s in with_states(home.node(i), i, view.world.states).states if s not in USUAL]
    rooms = [home.ids[room] for room in indices(home.between[i] & home.rooms)]
    facts = ", ".join([*states, *(f"to {_name(room, view)}" for room in rooms if room != view.me.room)])
    return _name(home.ids[i], view) + (f" ({facts})" if facts else "")


def _name(node: int, view: View) -> str:
    home = view.world.home
    return f"{home.classes[home.index[node]]} {node}"


def _things(nodes: Sequence[int], view: View) -> str:
    return ", ".join(_name(node, view) for node in nodes) or "nothing"


def plain(step: Step) -> str:
    """Return an instruction as texts have it: `PutBack cup 41, table 55`."""
    objects = ", ".join(f"{ref.name} {ref.node}" for ref in step.objects)
    return f"{step.action} {objects}".rstrip()


def menu(options: Sequence[Step], view: View) -> str:
    """Return the legal instructions by action, each with the number that answers it.

    At most `MOST_LISTED` of an action, rooms first, and none about walls and floors, are numbered; all can be written.
    """
    lines = ["What you can do now; answer with a number, or write it, as in `Grab cup 41`:"]
    for action, group in groupby(enumerate(options), lambda pair: pair[1].action):
        kinds = [(_kind(step, view), n, step) for n, step in group]
        useful = [each for each in sorted(kinds, key=lambda each: each[:2]) if each[0] != _STRUCTURE]
        listed = [f"{n} {plain(step)[len(action) :].strip()}".rstrip() for _, n, step in useful[:MOST_LISTED]]
        if len(listed) < len(kinds):
            listed.append(f"{len(kinds) - len(listed)} more can be written")
        lines.append(f"  {action}: {'; '.join(listed)}")
    return "\n".join((*lines, f"  {WAIT}: do nothing", ""))


_ROOM, _THING, _STRUCTURE = range(3)


def _kind(step: Step, view: View) -> int:
    """Return the kind of an instruction's node: a room, a thing, or a wall or a floor."""
    home = view.world.home
    nodes = [home.index[ref.node] for ref in step.objects if ref.node is not None]
    if any(home.rooms >> i & 1 for i in nodes):
        return _ROOM
    built = UNTOUCHED - {CHARACTER_CATEGORY}
    return _STRUCTURE if any(home.node(i).category in built for i in nodes) else _THING
