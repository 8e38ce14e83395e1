"""`gymnasium.make`: ids of ours, with names instead of objects, in one and in many environments; what it refuses."""

from __future__ import annotations

import pickle
import subprocess
import sys
import warnings

import pytest

pytest.importorskip("gymnasium", reason="the extra `agents` is not installed")

import gymnasium as gym
import numpy as np
from gymnasium.utils.env_checker import check_env, data_equivalence

from hearth.challenges.named_task_envs import REGISTERED, register
from hearth.envs.gymnasium_env import HomeEnv
from hearth.envs.rewards import Rewards
from hearth.envs.session import Session, Setting, opening
from hearth.schemas.diagnostics import HearthError

register()

GOAL = "ON(milk, table)"
THIN = {
    "home": "maple", "goal": GOAL, "code": "fixed", "actions": ["Close", "Grab", "Open", "PutBack", "Walktowards"],
    "things": ["kitchen", "fridge", "milk", "table"], "sizes": {"nodes": 16, "edges": 32},
    "arrays": ["seen", "states", "action_mask"], "limit": 20,
}  # fmt: skip


def one_point(before, after, agent):
    """A reward as a plain function."""
    return 1.5 if after[0].satisfied else -0.25


def test_it_makes_a_home_by_names():
    env = gym.make("hearth/Home-v0", home="maple", goal=GOAL)
    observation, info = env.reset(seed=1)
    assert env.observation_space.contains(observation) and info["success"] is False
    assert isinstance(env.unwrapped, HomeEnv)


@pytest.mark.parametrize("name", ["hearth/Home-v0", "hearth/WatchAndHelp-v0", "hearth/Household-v0"])
def test_gymnasium_accepts_what_it_makes(name):
    settings = {} if "Home-" in name else {"limit_tasks": 4}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*is different from the unwrapped.*")
        warnings.filterwarnings("ignore", message=".*no render.*")
        check_env(gym.make(name, **settings).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_many_at_once(mode):
    envs = gym.make_vec("hearth/Home-v0", num_envs=2, vectorization_mode=mode, **THIN)
    try:
        first, _ = envs.reset(seed=3)
        again, _ = envs.reset(seed=3)
        assert data_equivalence(first, again) and first["seen"].shape == (2, 16) and set(first) == set(THIN["arrays"])
        _, rewards, *_ = envs.step(np.array([0, 0]))
        assert rewards.tolist() == pytest.approx([-0.004, -0.004])
    finally:
        envs.close()


def test_goals_and_homes_differ_by_seed():
    begin = opening(["maple", "birch"], [GOAL, "HOLDS(agent, milk)"], agents=1)
    drawn = {(begin(seed)[0].home.name, str(begin(seed)[1])) for seed in range(20)}
    assert len(drawn) == 4
    assert begin(7)[0].graph() == begin(7)[0].graph() and begin(7)[1] == begin(7)[1]


def test_a_task_is_drawn_by_seed_and_its_helper_has_a_partner():
    env = gym.make("hearth/WatchAndHelp-v0", split="train", role="helper", limit_tasks=5).unwrapped
    goals = set()
    for seed in range(6):
        env.reset(seed=seed)
        goals.add(str(env.session.progress.goal))
        assert not env.session.succeeded
    assert len(goals) > 1 and env.learner == 1 and len(env.session.env.world.agents) == 2
    env.step(0)


def test_a_reward_is_any_function():
    env = gym.make("hearth/Home-v0", home="maple", goal=GOAL, rewards=one_point)
    env.reset(seed=1)
    assert env.step(0)[1] == -0.25
    assert Rewards(tick=-1.0)(*[(env.unwrapped.session.progress, env.unwrapped.session.env.world)] * 2, 0) == -1.0


def test_an_opening_alone_has_the_usual_settings(maple):
    assert HomeEnv(opening(maple, GOAL, agents=1)).session.setting.limit == 250


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Session(3), "int, not by a Setting"),
        (lambda: Session(Setting(opening("maple", GOAL), rewards=7)), "int, which can't be called"),
        (lambda: opening(None, GOAL), "NoneType"),
        (lambda: opening("nowhere", GOAL), "no home `nowhere`"),
        (lambda: opening([], GOAL), "0 homes"),
        (lambda: gym.make("hearth/Home-v0", home="maple", goal=GOAL, hands=3), "no setting is called `hands`"),
        (lambda: gym.make("hearth/Home-v0", home="maple", goal=GOAL, arrays=["smell"]), "no array is called `smell`"),
        (lambda: gym.make("hearth/WatchAndHelp-v0", role="chief"), "no role `chief`"),
        (lambda: gym.make("hearth/WatchAndHelp-v0", split="nope"), "no split `nope`"),
        (lambda: gym.make("hearth/WatchAndHelp-v0", limit_tasks=0), "no tasks"),
    ],
)
def test_faults_explain(make, said):
    with pytest.raises(HearthError) as caught:
        make()
    (fault,) = caught.value.diagnostics
    assert said in fault.message and fault.suggestion


def test_openings_and_settings_are_pickled():
    begin = opening("maple", GOAL, agents=1)
    setting = Setting(begin, rewards=one_point)
    copy = pickle.loads(pickle.dumps(setting))
    assert copy.opening(5)[0].graph() == begin(5)[0].graph() and copy.rewards is one_point


def test_step_comes_after_reset(maple):
    pytest.importorskip("pettingzoo")
    from hearth.envs.pettingzoo_env import ParallelHome

    with pytest.raises(HearthError, match="OUT_OF_ORDER"):
        ParallelHome(Setting(opening(maple, GOAL))).step({})
    with pytest.raises(HearthError, match="OUT_OF_ORDER"):
        HomeEnv(opening(maple, GOAL, agents=1)).step(0)


ALONE = """
import sys
sys.modules["pettingzoo"] = None
import gymnasium, hearth
env = gymnasium.make("hearth/Home-v0", home="maple", goal="HOLDS(agent, milk)")
env.reset(seed=0)
print(env.step(0)[1], sorted(name for name in gymnasium.registry if name.startswith("hearth/")))
"""


def test_importing_both_registers_and_one_agent_needs_no_pettingzoo():
    done = subprocess.run([sys.executable, "-c", ALONE], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == f"-0.004 {sorted(REGISTERED)}"
