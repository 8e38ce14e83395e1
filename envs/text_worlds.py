"""A world that is played in text, as a value: its state, and the effect of a command."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Protocol

from hearth.envs.answer_forms import WALK, read_answer
from hearth.envs.compact_text import compact, said_step, wanted_nodes
from hearth.envs.rewards import USUAL_REWARDS, Reward
from hearth.envs.session import MOST_TICKS
from hearth.envs.text_layout import printable
from hearth.envs.text_protocol_settings import Protocol as Words
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.simulation import engine
from hearth.simulation.actions.legal import Legal, legal
from hearth.simulation.goals import Progress
from hearth.simulation.observation.views import LastAction, View, view
from hearth.simulation.observation.visible_nodes import visible
from hearth.simulation.rules import DEFAULT, Rules
from hearth.simulation.world.world import World

_BRACKETED = re.compile(r"\[([A-Za-z]+)\]|<([a-z_ ]+)>(?: \(\d+\))?")


class Task(Protocol):
    """A task: an id, a goal, a start.

    It may have more: `instruction`, the goal as somebody says it, and `rules`, those of actions in its challenge.
    """

    @property
    def id(self) -> str:
        """Return its identifier."""

    @property
    def goal(self) -> Goal:
        """Return its goal."""

    @property
    def start(self) -> Callable[..., World]:
        """Return the function that gives the world in which it begins."""


@dataclass(frozen=True, eq=False)
class Play:
    """Settings of worlds that are played in text.

    Attributes:
        words: the protocol.
        actions: names of the actions that may be tried.
        limit: ticks after which a world ends.
        reward: of a tick.
        travel: whether a walk goes on until one arrives.
        rules: of actions, for tasks that have none of their own.
        partial: whether the agent sees only the area around it.
    """

    words: Words
    actions: frozenset[str]
    limit: int = MOST_TICKS
    reward: Reward = USUAL_REWARDS
    travel: bool = True
    rules: Rules = DEFAULT
    partial: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class TextWorld:
    """A world that is played in text; agent 0 acts.

    Attributes:
        task: its task.
        world: as it is now.
        progress: of the goal.
        ticks: how many have passed.
        last: the last instruction, and its failure.
        fault: why the last command was not tried; None where it was.
        faults: how many commands were not tried.
        limit: ticks after which it ends.
        stopped: whether the last walk ended early because something wanted came into sight.
    """

    task: Task
    world: World
    progress: Progress
    ticks: int = 0
    last: LastAction | None = None
    fault: Diagnostic | None = None
    faults: int = 0
    limit: int = MOST_TICKS
    stopped: bool = False

    @property
    def won(self) -> bool:
        """Return whether the goal is reached."""
        return self.progress.satisfied

    @property
    def cut_off(self) -> bool:
        """Return whether time is over and the goal is not reached."""
        return self.ticks >= self.limit and not self.won

    @property
    def over(self) -> bool:
        """Return whether no command can follow."""
        return self.won or self.cut_off


def fitted(play: Play, task: Task) -> Play:
    """Return the settings of a task's worlds: a task of a challenge is played by the rules of the challenge."""
    rules = getattr(task, "rules", play.rules)
    return play if rules == play.rules else _ruled(play, rules)


@lru_cache(maxsize=64)
def _ruled(play: Play, rules: Rules) -> Play:
    return replace(play, rules=rules)


def begun(task: Task, play: Play, knowledge: Any) -> TextWorld:
    """Return the world of a task at its start.

    Raises:
        HearthError: those of the task's start and goal.
    """
    goal_in = getattr(task, "goal_in", None)
    if goal_in is not None:  # a task of a challenge: its goal names classes of furniture, of which a home has several
        world = task.start(knowledge, 1)
        goal = goal_in(world.home)
    else:
        world, goal = task.start(), task.goal
    return TextWorld(task, world, Progress.start(goal, world), limit=play.limit)


def seen(now: TextWorld, play: Play) -> tuple[View, Legal]:
    """Return the agent's observation and its legal actions."""
    last = {} if now.last is None else {0: now.last}
    found = view(now.world, 0, partial=play.partial, last_actions=last, tick=now.ticks)
    return found, legal(now.world, 0, play.rules, only_visible=play.partial, actions=play.actions)


def observed(now: TextWorld, play: Play, shown: tuple[View, Legal] | None = None) -> str:
    """Return the observation in words."""
    may = shown or seen(now, play)
    note = "" if now.fault is None else f"refused, you waited. {reason(now.fault)}"
    task = getattr(now.task, "instruction", "")
    broken = tuple(map(str, now.progress.broken))
    return compact(*may, now.progress.goal, play.words, task, note, stopped=now.stopped, broken=broken)


def reason(fault: Diagnostic) -> str:
    """Return the reason for a refusal and its remedy, in characters that can be printed."""
    remedy = f" ({_in_words(fault.suggestion)})" if fault.suggestion else ""
    return printable(f"{fault.code}: {_in_words(fault.message)}{remedy}")


def _in_words(text: str) -> str:
    """Return the words of a fault with actions and things as commands write them: `Walk`, not `[Walktowards]`."""
    return _BRACKETED.sub(lambda found: said_step(found[1] or found[2]), text)


def commanded(now: TextWorld, answer: object, play: Play, shown: tuple[View, Legal]) -> tuple[TextWorld, float]:
    """Return the world after a command, and the reward of its ticks.

    A command that is not understood does nothing for a tick, and the world says why. A world that is over stays as it
    is: its fault is OUT_OF_ORDER.
    """
    if now.over:
        message = f"the world of {now.task.id} is over"
        late = Diagnostic(Code.OUT_OF_ORDER, message, suggestion="call `reset`")
        return replace(now, fault=late, faults=now.faults + 1), 0.0
    step: Step | None = None
    fault: Diagnostic | None = None
    try:
        step = read_answer(answer, *shown, play.words)
    except HearthError as error:
        fault = error.diagnostics[0]
    heard = now if fault is None and now.fault is None and not now.stopped else _with_fault(now, fault)
    after, reward = _ticked(heard, step, play)
    if step is not None and step.action == WALK and play.travel:
        after, more = _walked_on(after, step, play, shown[0])
        reward += more
    return after, reward


def _ticked(now: TextWorld, step: Step | None, play: Play) -> tuple[TextWorld, float]:
    """Return the world a tick later, and the reward."""
    world, failures = engine.tick(now.world, {} if step is None else {0: step}, play.rules)
    done = [] if step is None or failures else [step]
    progress = now.progress.then(now.world, world, done)
    last = now.last if step is None else LastAction(step, failures.get(0))
    reward = play.reward((now.progress, now.world), (progress, world), 0)
    # `dataclasses.replace` takes five times as long.
    after = TextWorld(now.task, world, progress, now.ticks + 1, last, now.fault, now.faults, now.limit, now.stopped)
    return after, reward


def _with_fault(now: TextWorld, fault: Diagnostic | None) -> TextWorld:
    """Return a world whose last walk did not stop, with the reason why its command is not tried, or None."""
    return replace(now, fault=fault, faults=now.faults + (fault is not None), stopped=False)


def _walked_on(now: TextWorld, step: Step, play: Play, began: View) -> tuple[TextWorld, float]:
    """Walk on until one arrives, is stopped, or sees something wanted for the first time on this way."""
    total, place = 0.0, began.me.place
    for _ in range(play.words.most_walked):
        here = now.world.agents[0].pose
        stopped = now.last is not None and now.last.failure is not None
        if stopped or now.over or here == place:
            break
        if _sights(now, play, began):
            return replace(now, stopped=step in _may(now, step, play)), total
        if step not in _may(now, step, play):
            break
        place = here
        now, reward = _ticked(now, step, play)
        total += reward
    return now, total


def _may(now: TextWorld, step: Step, play: Play) -> Legal:
    return legal(now.world, 0, play.rules, only_visible=play.partial, actions=frozenset({step.action}))


def _sights(now: TextWorld, play: Play, began: View) -> bool:
    """Return whether a wanted thing is in sight that was not when the walk began."""
    world = now.world
    here = visible(world, world.agent(0)) if play.partial else world.home.everything
    return bool(wanted_nodes(now.progress.goal, world.home, here) & ~began.mask)
