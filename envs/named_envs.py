"""Environments by name, as `gymnasium.make` takes them: `hearth/Home-v0`, with names instead of objects."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

if TYPE_CHECKING:
    from hearth.agents.protocol import Agent
    from hearth.envs.gymnasium_env import HomeEnv
    from hearth.envs.session import Setting
    from hearth.schemas.goals import Goal
    from hearth.simulation.world.home import Home

REGISTERED = {"hearth/Home-v0": "hearth.envs.named_envs:home_env"}
"""Function that makes the environment of each id; those of tasks are in `challenges.named_task_envs`."""


def register(ids: Mapping[str, str] = REGISTERED) -> None:
    """Give Gymnasium the ids that it does not have yet."""
    from gymnasium.envs.registration import register as add
    from gymnasium.envs.registration import registry

    for name, function in ids.items():
        if name not in registry:
            add(id=name, entry_point=function)


def home_env(
    home: Home | str | Sequence[Home | str] = "maple",
    goal: Goal | str | Sequence[Goal | str] = "HOLDS(agent, milk)",
    agents: int = 1,
    partners: Sequence[Agent] = (),
    learner: int = 0,
    render_mode: str | None = None,
    camera: str = "plan",
    **settings: Any,
) -> HomeEnv:
    """Return the environment of `hearth/Home-v0`.

    Args:
        home: the home, its name, or several, of which the seed draws one.
        goal: as text; of several the seed draws one.
        agents: how many, the learner and its partners.
        partners, learner, render_mode, camera: as of `gymnasium_env.HomeEnv`.
        settings: fields of `session.Setting`; `sizes` may be a dict, `code` may be `fixed`.

    Raises:
        HearthError: BAD_ARGUMENT: a setting that there is not; the faults of homes and goals.
    """
    from hearth.envs.gymnasium_env import HomeEnv
    from hearth.envs.session import opening

    setting = setting_of(opening(home, goal, agents), settings)
    return HomeEnv(setting, partners, learner, render_mode, camera)


def setting_of(begin: Any, settings: Mapping[str, Any]) -> Setting:
    """Return the settings of keywords.

    Raises:
        HearthError: BAD_ARGUMENT: a keyword that there is not.
    """
    from hearth.envs.observation_arrays import Sizes
    from hearth.envs.session import Setting

    known = [each.name for each in fields(Setting) if each.name != "opening"]
    given = dict(settings)
    if unknown := [name for name in given if name not in known]:
        message = f"no setting is called `{unknown[0][:40]}`"
        raise HearthError.of(Code.BAD_ARGUMENT, message, suggestion=", ".join(known))
    if isinstance(given.get("sizes"), Mapping):
        given["sizes"] = Sizes(**given["sizes"])
    for name in ("actions", "things", "arrays"):
        if given.get(name) is not None:
            given[name] = tuple(given[name])
    return Setting(begin, **given)
