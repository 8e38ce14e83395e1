"""A game: a trial under way. Its decisions determine it: a replay from the store gives the same game."""

from collections.abc import Mapping

from hearth.agents.agent_registry import HELPERS
from hearth.agents.online_helper_registry import ONLINE
from hearth.agents.protocol import Agent
from hearth.challenges.agent_guard import AgentError, Guarded
from hearth.challenges.episode_agents import partial_of
from hearth.challenges.episode_loop import Playing
from hearth.challenges.episodes import Record, measured, read_instruction, start_of, written
from hearth.envs.agent_answers import by_text
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.simulation.actions.legal import Legal
from hearth.simulation.env import Tick
from hearth.simulation.observation.views import View
from hearth.simulation.world.digest import digest
from hearth.web.play.play_trials import OTHERS, PERSON, PROGRAM, Trial
from hearth.web.play.player_memory import Remembered

Texts = tuple[str | None, ...]
"""Each character's attempt in a tick, as records have it (`Grab 41`); None where it waited."""

HELPER = 1
"""The number of the helper."""


class Person:
    """A person as main agent, whose subgoal is unknown."""

    subgoal = None


class Game:
    """A trial under way.

    Attributes:
        trial: the trial that is played.
        playing: the episode.
        seen: each person's observations so far, by its number.
        end: why it ended before its goal and time, as records have it; None if it did not.

    Args:
        trial: the trial that is played.
        knowledge: of its home.
        program: a user's own helper.
    """

    def __init__(self, trial: Trial, knowledge: Knowledge, program: Agent | None = None) -> None:
        which = trial.challenge
        self.trial = trial
        self.start = start_of(trial.task, knowledge, None if trial.helped else 1)
        home = self.start.home
        self.goals: list[Goal | None] = [trial.task.goal_in(home)]
        if trial.helped:
            asked = trial.helper_goal
            self.goals.append(None if asked is None else which.grammar.in_home(asked, home))
        self.allowed = which.allowed(knowledge)
        self._helper = program if trial.helper in OTHERS else made(trial)
        assert self.goals[0] is not None
        self.playing = Playing(
            self.start,
            self.goals[0],
            [trial.partial, *([self._helper_partial()] if trial.helped else [])],
            actions=self.allowed,
            limit=which.ticks,
            rules=which.rules,
        )
        self.end: dict[str, object] | None = None
        self.texts: list[Texts] = []
        self._begun = False
        self._unasked: list[tuple[View, Legal]] = []
        self._answer: tuple[str | None] | None = None
        self.seen = {number: Remembered(self.view(number), self.goals[number]) for number in trial.people}

    def _helper_partial(self) -> bool:
        if self.trial.helper == PERSON:
            return self.trial.partial
        own = partial_of(self._helper)
        return self.trial.challenge.partial if own is None else own

    @property
    def tick(self) -> int:
        """Return how many ticks have passed; the number of the next decision."""
        return len(self.texts)

    @property
    def over(self) -> bool:
        """Return whether nothing more can be done."""
        return self.end is not None or self.playing.over

    def view(self, number: int) -> View:
        """Return a character's current view."""
        return self.playing.view(number)

    def legal(self, number: int) -> Legal:
        """Return a character's currently legal actions."""
        return self.playing.legal(number)

    def read(self, number: int, text: str | None) -> str | None:
        """Return a decision of a person, as records have it; None to wait.

        Raises:
            HearthError: it can't be done now, as far as the person sees; nothing changes then.
        """
        step = None if text is None else by_text(text, self.view(number), self.legal(number))
        return written(step)

    def helper_decides(self) -> str | None:
        """Return the choice of an agent that helps, in this tick.

        The agent is asked once a tick, however often this is called.

        Raises:
            AgentError: it can't go on.
        """
        if self._helper is None:
            return None
        if self._answer is None:
            agent = self._asked()
            self._answer = (written(agent.act(self.view(HELPER), self.legal(HELPER))),)
        return self._answer[0]

    def _asked(self) -> Guarded:
        """Return the helper, begun, and shown every tick that the store knew."""
        assert self._helper is not None
        agent = Guarded(self._helper, HELPER, self.allowed)
        if not self._begun:
            first = self._unasked[0][0] if self._unasked else self.view(HELPER)
            agent.reset(first, self.goals[HELPER], derive(self.trial.episode_seed, "agent", HELPER))
            self._begun = True
        while self._unasked:
            agent.act(*self._unasked.pop(0))
        return agent

    def use(self, program: Agent) -> None:
        """Let a program that has just connected be the helper; its observations begin with the next tick."""
        self._helper, self._begun = program, False
        self._unasked, self._answer = [], None

    def advance(self, texts: Texts) -> Tick:
        """Run one tick with each character's attempt, from `read` and `helper_decides` or from the store."""
        if self._answer is None and self._helper is not None and self.trial.helper != PROGRAM:
            self._unasked.append((self.view(HELPER), self.legal(HELPER)))
        self._answer = None
        home = self.start.home
        steps: Mapping[int, Step] = {
            number: read_instruction(text, number, home, self.allowed)
            for number, text in enumerate(texts)
            if text is not None
        }
        done = self.playing.step(steps)
        self.texts.append(texts)
        for number, known in self.seen.items():
            known.add(self.view(number), done)
        return done

    def stop(self, number: int, code: Code, message: str) -> None:
        """End the game: a person left, or an agent can't go on."""
        self.end = {"agent": number, "code": str(code), "message": message}

    def record(self) -> Record:
        """Return the episode as result files have it (see `challenges.result_files`)."""
        trial, playing = self.trial, self.playing
        metrics = measured(trial.challenge, self.start, playing.env.ticks, self.goals, playing.progress)
        asked = trial.helper_goal if trial.helped else None
        goal = None if asked is None else trial.challenge.grammar.written(asked)
        final = digest(playing.env.world)
        end = None if playing.over else self.end or _UNFINISHED
        return Record(trial.task.id, trial.seed, trial.helped, goal, tuple(self.texts), final, metrics.as_json(), end)


_UNFINISHED = {"agent": 0, "code": str(Code.DISCONNECTED), "message": "not finished yet"}


def made(trial: Trial) -> Agent:
    """Return the agent that helps in a trial."""
    if trial.helper in HELPERS:
        return HELPERS[trial.helper].make(Person())
    return ONLINE[trial.helper].make(trial.challenge.goals_in)


def fault_of(error: AgentError) -> tuple[Code, str]:
    """Return why an agent can't go on, as `Game.stop` takes it."""
    return error.fault.code, error.fault.message
