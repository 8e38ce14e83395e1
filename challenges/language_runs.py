"""Runs of agents on tasks from Python, with endpoints of language models in place of names."""

from __future__ import annotations

from pathlib import Path

from hearth.challenges.episode_agents import NOBODY, Lineup
from hearth.challenges.parallel_episodes import here
from hearth.challenges.result_files import Results
from hearth.challenges.suite_runs import run
from hearth.challenges.task_files import Suite, read
from hearth.kb.loading.load import default
from hearth.llm.addresses import SCHEME
from hearth.llm.endpoint import OWN, Endpoint
from hearth.llm.language_settings import Asking, Means
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def run_tasks(
    tasks: Suite | str | Path,
    main: str | Endpoint = "human_like",
    helper: str | Endpoint = NOBODY,
    *,
    out: str | Path,
    goal: str = "",
    seeds: int = 1,
    workers: int = 1,
) -> Results:
    """Let an agent do tasks, alone and with a helper, and write all that they did, as `challenge run` does.

    Args:
        tasks: of `hearth.suite`, or a file of tasks.
        main: the agent that acts: a name as `challenge run` takes it, or an endpoint.
        helper: the agent that helps, in the same ways.
        out: the file of results, `.jsonl`. An existing run of the same agents goes on.
        goal: the helper's goal; as its row says where empty.
        seeds: episodes of each task.
        workers: episodes at the same time.

    Raises:
        HearthError: those of `suite_runs.run`; BAD_ARGUMENT: two endpoints have different settings.

    Examples:
        >>> model = hearth.Endpoint(model="idle", client=lambda messages: "wait")
        >>> tasks = hearth.suite("household", "valid_seen", limit=1)
        >>> found = hearth.run_tasks(tasks, model, out="idle.jsonl")
        >>> found.summary()["success"]
        0.0
    """
    endpoints = tuple((_name(each), each) for each in (main, helper) if isinstance(each, Endpoint))
    settings = {each.asking for _, each in endpoints}
    if len(settings) > 1:
        message = "the endpoints of the agent and its helper have different settings"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion="give both the same `asking`")
    asking = next(iter(settings), Asking())
    prices = next((each.means.prices for _, each in endpoints), None)
    lineup = Lineup(_name(main), _name(helper), goal, asking=asking, means=Means(given=endpoints, prices=prices))
    suite = tasks if isinstance(tasks, Suite) else read(Path(tasks))
    return run(suite, lineup, seeds, Path(out), default, workers, over=here(workers))


def _name(agent: str | Endpoint) -> str:
    if isinstance(agent, str):
        return agent
    return f"{SCHEME}{agent.model}" if agent.url == OWN else f"{SCHEME}{agent.model}@{agent.url}"
