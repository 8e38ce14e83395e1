"""Text environments for language models: one world, and many worlds in one process.

Worlds are values. What a world answers depends on its own task and commands alone, whatever the others do.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import TYPE_CHECKING, Any

from hearth.agents.agent_registry import MAIN
from hearth.envs.action_codes import played
from hearth.envs.answer_forms import WALK
from hearth.envs.compact_text import said_step
from hearth.envs.rewards import USUAL_REWARDS, Reward, checked_reward
from hearth.envs.session import MOST_TICKS, Opening, opening
from hearth.envs.text_agent import plain
from hearth.envs.text_protocol_settings import CURRENT
from hearth.envs.text_protocol_settings import protocol as words_of
from hearth.envs.text_worlds import Play, Task, TextWorld, begun, commanded, fitted, observed, seen
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.rng import rng
from hearth.simulation.actions.legal import Legal
from hearth.simulation.observation.views import View
from hearth.simulation.world import edge_rows
from hearth.simulation.world.world import World

if TYPE_CHECKING:
    from hearth.kb.knowledge import Knowledge

Info = dict[str, Any]
"""Facts about a world that the agent must not observe."""

MOST_WORLDS = 100_000
"""Worlds of one environment."""

REMEDY = "TextHomes(hearth.challenges.published_tasks.tasks('wah', 'train'), worlds=8)"


@dataclass(frozen=True)
class SeededTask:
    """An episode of an opening, as a task.

    Attributes:
        id: `seed-` and the seed.
        begin: gives the world and the goal of a seed.
        seed: of this episode.
    """

    id: str
    begin: Opening
    seed: int

    @property
    def goal(self) -> Goal:
        """Return its goal."""
        return self.begin(self.seed)[1]

    def start(self) -> World:
        """Return the world in which it begins."""
        return self.begin(self.seed)[0]


class Admissible(Sequence[str]):
    """All legal commands of a world, written when they are asked for: a few hundred, of which prompts list some."""

    def __init__(self, legal: Legal) -> None:
        self._legal = legal

    def __len__(self) -> int:
        return len(self._legal) + 1

    def __iter__(self) -> Iterator[str]:
        yield from (said_step(plain(step)) for step in self._legal)
        yield "wait"

    def __getitem__(self, number: Any) -> Any:
        if isinstance(number, slice):
            return list(self)[number]
        at = range(len(self))[number]
        return next(islice(self, at, None))

    def __repr__(self) -> str:
        return f"Admissible({len(self)} commands)"


@dataclass
class _Place:
    """One of the worlds of an environment: what it shows now, and its expert."""

    now: TextWorld
    text: str
    shown: tuple[View, Legal]
    expert: Any = field(default=None)


class TextHomes:
    """Many worlds that are played in text; agent 0 of each acts.

    Args:
        tasks: what there is to do: tasks of a challenge, or anything with `id`, `goal`, `start()`, and `instruction` if
            it has one.
        worlds: how many are played at once.
        group: so many neighbors share a task.
        seed: of the tasks that `reset` draws.
        protocol: the words of observations (see `text_protocol_settings`).
        reward: of a tick: `Rewards`, or a function of (progress, world) before and after it and the agent's number.
        travel: whether a walk goes on until one arrives.
        limit: ticks after which a world ends.
        actions: names of the actions that may be tried; those of challenges where None.
        expert: whether `info["expert"]` has the command of an agent that sees everything.
        knowledge: what homes are read with; ours where None.

    Attributes:
        fingerprint: digest of the protocol; results name it.
        instructions: how to act, for the first message to a language model.

    Raises:
        HearthError: BAD_ARGUMENT: no tasks, a number that is out of range, an unknown protocol.

    Examples:
        >>> from hearth.challenges.published_tasks import tasks
        >>> homes = hearth.TextHomes(tasks("wah", "train", limit=4), worlds=2)
        >>> observations, infos = homes.reset(indices=[0, 1])
        >>> observations, rewards, terminated, truncated, infos = homes.step(["wait", "fly"])
        >>> infos[1]["fault"]["code"]
        'UNKNOWN_ACTION'
    """

    def __init__(
        self,
        tasks: Iterable[Task],
        worlds: int = 64,
        group: int = 1,
        seed: int = 0,
        protocol: str = CURRENT,
        reward: Reward = USUAL_REWARDS,
        travel: bool = True,
        *,
        limit: int = MOST_TICKS,
        actions: Iterable[str] | None = None,
        expert: bool = False,
        knowledge: Knowledge | None = None,
    ) -> None:
        self._tasks = _listed(tasks)
        self.worlds, self.group = _count(worlds, "worlds"), _count(group, "group")
        if worlds % group:
            raise HearthError.of(Code.BAD_ARGUMENT, f"{worlds} worlds are no whole groups of {group}",
                                 suggestion=f"worlds={max(group, worlds // group * group)}")  # fmt: skip
        self._knowledge = knowledge or _ours()
        allowed = frozenset(played(self._knowledge) if actions is None else actions)
        self._play = Play(words_of(protocol), allowed, _count(limit, "limit"), checked_reward(reward), travel)
        self._seed, self._draws, self._with_expert = seed, 0, expert
        self._places: list[_Place] = []

    @property
    def fingerprint(self) -> str:
        """Return the digest of the protocol."""
        return self._play.words.fingerprint

    @property
    def instructions(self) -> str:
        """Return how to act."""
        return self._play.words.instructions

    def reset(
        self, indices: Sequence[int] | None = None, seeds: Sequence[int] | None = None
    ) -> tuple[list[str], list[Info]]:
        """Begin all worlds anew, and return their observations and infos.

        Args:
            indices: numbers of the tasks, one for each group.
            seeds: each draws the task of a group; equal seeds draw equal tasks. Where both are left out, tasks are
                drawn from the seed of the environment, others each time.

        Raises:
            HearthError: BAD_ARGUMENT: both are given, not one for each group, or there is no task of a number; the
                faults of a task's start. The worlds are as before.
        """
        chosen = self._chosen(indices, seeds)
        starts = [begun(self._tasks[number], self._play, self._knowledge) for number in chosen]
        self._places = [self._placed(start) for start in starts for _ in range(self.group)]
        return [place.text for place in self._places], [self._info(place) for place in self._places]

    def _chosen(self, indices: Sequence[int] | None, seeds: Sequence[int] | None) -> list[int]:
        groups, count = self.worlds // self.group, len(self._tasks)
        if indices is not None and seeds is not None:
            raise HearthError.of(Code.BAD_ARGUMENT, "`indices` and `seeds` are both given", suggestion="give one")
        given = indices if indices is not None else seeds
        if given is None:
            self._draws += 1
            return [rng(self._seed, "task", self._draws, n).randrange(count) for n in range(groups)]
        if len(given) != groups or not all(isinstance(n, int) for n in given):
            name = "indices" if indices is not None else "seeds"
            message = f"`{name}` has {len(given)} values, where {groups} whole numbers are expected"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="one for each group of worlds")
        if indices is None:
            return [rng(n, "task").randrange(count) for n in given]
        if wrong := [n for n in given if not 0 <= n < count]:
            message = f"there is no task {wrong[0]}"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"0 to {count - 1}")
        return list(given)

    def step(self, answers: Sequence[str]) -> tuple[list[str], list[float], list[bool], list[bool], list[Info]]:
        """Give each world its answer.

        An answer that is not understood takes a tick, and `info["fault"]` says why. A world that is over stays as it
        is, with the fault OUT_OF_ORDER.

        Returns:
            Observations, rewards, whether the goal is reached, whether time is over, and infos.

        Raises:
            HearthError: OUT_OF_ORDER before `reset`; BAD_ARGUMENT: not one answer for each world. No world is changed.
        """
        self._need_begun()
        if isinstance(answers, (str, bytes)) or len(answers) != len(self._places):
            some = "one text" if isinstance(answers, (str, bytes)) else f"{len(answers)} answers"
            message = f"{some} for {len(self._places)} worlds"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="a list with one answer for each world")
        rewards = [self._stepped(number, answer) for number, answer in enumerate(answers)]
        places = self._places
        over = [place.now.won for place in places], [place.now.cut_off for place in places]
        return [place.text for place in places], rewards, *over, [self._info(place) for place in places]

    def _stepped(self, number: int, answer: str) -> float:
        place = self._places[number]
        was_over = place.now.over
        now, reward = commanded(place.now, answer, fitted(self._play, place.now.task), place.shown)
        if was_over:
            place.now = now
        else:
            self._places[number] = self._placed(now, place.expert)
        return reward

    def _placed(self, now: TextWorld, expert: Any = None) -> _Place:
        play = fitted(self._play, now.task)
        shown = seen(now, play)
        if expert is None and self._with_expert:
            expert = MAIN["oracle"](())  # type: ignore[arg-type]
            expert.reset(shown[0], now.progress.goal, 0)
        return _Place(now, observed(now, play, shown), shown, expert)

    def _info(self, place: _Place) -> Info:
        now = place.now
        fault = now.fault
        found: Info = {
            "id": now.task.id,
            "won": now.won,
            "goal_fraction": now.progress.fraction,
            "broken": [str(part) for part in now.progress.broken],
            "admissible": Admissible(place.shown[1]),
            "fault": None if fault is None else _fault(fault),
            "faults": now.faults,
            "ticks": now.ticks,
            "protocol": self.fingerprint,
        }
        if self._with_expert:
            found["expert"] = self._expert(place)
        return found

    def _expert(self, place: _Place) -> str:
        if place.now.over:
            return "wait"
        step = place.expert.act(*seen(place.now, replace(fitted(self._play, place.now.task), partial=False)))
        return "wait" if step is None else said_step(plain(_towards(step, place.shown[0])))

    def snapshot(self) -> tuple[TextWorld, ...]:
        """Return the worlds as they stand; values, which cost nothing to keep.

        Raises:
            HearthError: OUT_OF_ORDER before `reset`.
        """
        self._need_begun()
        return tuple(place.now for place in self._places)

    def restore(self, snapshot: Sequence[TextWorld]) -> tuple[list[str], list[Info]]:
        """Go on from a snapshot, of this environment or of an equal one; return observations and infos.

        Raises:
            HearthError: BAD_ARGUMENT: it is not one world for each of ours.
        """
        if len(snapshot) != self.worlds or not all(isinstance(each, TextWorld) for each in snapshot):
            message = f"not a snapshot of {self.worlds} worlds"
            raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="restore(homes.snapshot())")
        self._places = [self._placed(now) for now in snapshot]
        return [place.text for place in self._places], [self._info(place) for place in self._places]

    def _need_begun(self) -> None:
        if not self._places:
            raise HearthError.of(Code.OUT_OF_ORDER, "no world has begun", suggestion="call `reset()`")


class TextHome:
    """One world that is played in text.

    Args:
        task: a task, or the name of a home.
        goal: with a home: the goal as text, or a list of goals of which the seed draws one.
        options: as of `TextHomes`: protocol, reward, travel, limit, actions, expert, knowledge.

    Examples:
        >>> home = hearth.TextHome("maple", "HOLDS(agent, milk)")
        >>> observation, info = home.reset(seed=1)
        >>> observation, reward, terminated, truncated, info = home.step("Walk fridge")
        >>> len(observation) <= 1200, info["fault"]
        (True, None)
    """

    def __init__(
        self, task: Task | str | Opening, goal: str | Goal | Sequence[str | Goal] = (), **options: Any
    ) -> None:
        self._options = options
        self._opening: Opening | None = None
        if isinstance(task, str):
            self._opening = opening(task, goal, agents=1)
        elif not hasattr(task, "goal") and callable(task):
            self._opening = task
        first = task if self._opening is None else SeededTask("seed-0", self._opening, 0)
        self._homes = TextHomes([first], worlds=1, **options)  # type: ignore[list-item]

    @property
    def fingerprint(self) -> str:
        """Return the digest of the protocol."""
        return self._homes.fingerprint

    @property
    def instructions(self) -> str:
        """Return how to act."""
        return self._homes.instructions

    def reset(self, seed: int = 0) -> tuple[str, Info]:
        """Begin anew; the seed decides where the agent stands, unless the task does."""
        if self._opening is not None:
            self._homes._tasks = (SeededTask(f"seed-{seed}", self._opening, seed),)
        texts, infos = self._homes.reset(indices=[0])
        return texts[0], infos[0]

    def step(self, answer: str) -> tuple[str, float, bool, bool, Info]:
        """Give the world an answer; see `TextHomes.step`."""
        texts, rewards, terminated, truncated, infos = self._homes.step([answer])
        return texts[0], rewards[0], terminated[0], truncated[0], infos[0]

    def snapshot(self) -> TextWorld:
        """Return the world as it stands, a value."""
        return self._homes.snapshot()[0]

    def restore(self, snapshot: TextWorld) -> tuple[str, Info]:
        """Go on from a snapshot."""
        texts, infos = self._homes.restore([snapshot])
        return texts[0], infos[0]


def _towards(step: Step, view: View) -> Step:
    """Return an expert's instruction for those who see less: about an unseen thing, a walk to its place or its room.

    An expert at a door reaches things of the next room that nobody sees from there.
    """
    home, world = view.world.home, view.world
    unseen = [ref.node for ref in step.objects if ref.node is not None and not view.sees(ref.node)]
    if not unseen:
        return step
    at = home.index[unseen[0]]
    while not view.mask >> at & 1:
        inside = edge_rows.inside(world, at)
        above = edge_rows.on(world, at) | inside & ~home.rooms or inside
        if not above:
            break
        at = (above & -above).bit_length() - 1
    return Step(WALK, (ObjectRef(home.classes[at], 0, home.ids[at]),), step.agent)


def _fault(fault: Any) -> Info:
    return {"code": str(fault.code), "message": fault.message, "remedy": fault.suggestion}


def _listed(tasks: Iterable[Task]) -> Sequence[Task]:
    found = tasks if isinstance(tasks, (list, tuple)) else tuple(tasks) if isinstance(tasks, Iterable) else ()
    if not found or not all(hasattr(each, "goal") and hasattr(each, "start") for each in found):
        raise HearthError.of(Code.BAD_ARGUMENT, "`tasks` holds no tasks", suggestion=REMEDY)
    return found


def _count(number: int, name: str) -> int:
    if not isinstance(number, int) or not 0 < number <= MOST_WORLDS:
        message = f"`{name}` is {str(number)[:40]}, not a whole number from 1"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=f"{name}=8")
    return number


def _ours() -> Knowledge:
    from hearth.kb.loading.load import default

    return default()
