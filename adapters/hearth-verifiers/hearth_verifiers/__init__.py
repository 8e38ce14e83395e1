"""Household tasks in text as a taskset of verifiers: `vf-eval hearth-verifiers`."""

import asyncio

import verifiers.v1 as vf

import hearth

__all__ = ["HearthEnv", "HearthTaskset"]


class HearthConfig(vf.TasksetConfig):
    """The tasks: of a source such as `wah:train`, or a home with a goal; and ticks of an episode."""

    tasks: str = "wah:train:100"
    home: str = ""
    goal: str = ""
    num_tasks: int = 20
    limit: int = 250


class HearthData(vf.TaskData):
    """A task: where it is from, and its seed."""

    tasks: str
    home: str
    goal: str
    seed: int
    limit: int

    def episode(self, **more: bool) -> hearth.TextEpisode:
        """Return its episode, which has begun."""
        whole = {"home": self.home, "goal": self.goal} if self.home or self.goal else {"tasks": self.tasks}
        made = hearth.TextEpisode(**whole, limit=self.limit, **more)
        made.reset(self.seed)
        return made


class HearthTask(vf.Task[HearthData]):
    """A task that is won or not; an agent that sees everything shows that it can be won."""

    @vf.reward
    async def won(self, trace: vf.Trace) -> float:
        """Return 1.0 where the goal was reached, else 0.0."""
        return float(trace.info.get("hearth", {}).get("won", False))

    @vf.metric
    async def played(self, trace: vf.Trace) -> dict[str, float]:
        """Return the reward of the engine, the part of the goal that was reached, faults, ticks and turns."""
        names = ("total", "goal_fraction", "faults", "ticks", "turn")
        return {name: float(trace.info.get("hearth", {}).get(name, 0)) for name in names}

    async def validate(self, runtime: vf.Runtime) -> bool:
        """Return whether the expert reaches the goal."""
        return await asyncio.to_thread(self._solved)

    def _solved(self) -> bool:
        episode = self.data.episode(expert=True)
        while not episode.turn.done:
            episode.step(episode.expert)
        return episode.turn.won


class HearthTaskset(vf.Taskset[HearthTask, HearthConfig]):
    """Tasks by seed; the first observation is the prompt."""

    def load(self):  # noqa: ANN201, as in the library's own tasksets
        """Yield the tasks."""
        c = self.config
        for seed in range(c.num_tasks):
            data = HearthData(tasks=c.tasks, home=c.home, goal=c.goal, seed=seed, limit=c.limit)
            episode = data.episode()
            said = {"prompt": episode.turn.observation, "system_prompt": episode.instructions}
            yield HearthTask(data.model_copy(update={"name": f"{episode.turn.task}#{seed}", **said}), c.task)


class HearthEnvConfig(vf.EnvConfig):
    """The player, a chat without tools, and the turns that it has."""

    player: vf.AgentConfig = vf.AgentConfig(harness={"id": "null"}, runtime={"type": "subprocess"})
    most_turns: int = 50


class HearthEnv(vf.Env[HearthEnvConfig]):
    """An episode: each answer is a command, and the next observation follows."""

    async def run(self, task: HearthTask, agents: vf.Agents) -> None:
        """Play until the world or the turns are over."""
        episode = await asyncio.to_thread(task.data.episode)
        async with agents.player.interaction(task) as talk:
            said = await talk.turn()
            while not said.terminated:
                turn = await asyncio.to_thread(episode.step, said.last_reply or "")
                talk.trace.info["hearth"] = {**turn.as_json(), "observation": ""}
                if turn.done or turn.turn >= self.config.most_turns:
                    break
                said = await talk.turn(turn.observation)
