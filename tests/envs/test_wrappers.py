"""The environments for libraries of reinforcement learning: those libraries' own checkers, and what ours promise."""

from __future__ import annotations

import random
import subprocess
import sys
import warnings

import numpy as np
import pytest

pytest.importorskip("gymnasium", reason="the extra `agents` is not installed")
pytest.importorskip("pettingzoo", reason="the extra `agents` is not installed")

import gymnasium
from gymnasium.utils.env_checker import check_env, data_equivalence
from pettingzoo.test import api_test, max_cycles_test, parallel_api_test, parallel_seed_test, seed_test

from hearth.envs import pettingzoo_env
from hearth.envs.action_codes import fixed_list, str_step
from hearth.envs.gymnasium_env import HomeEnv
from hearth.envs.pettingzoo_env import ParallelHome
from hearth.envs.rewards import HIERARCHICAL, Rewards, metres_left
from hearth.envs.session import Setting, opening
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.episode import Episode
from hearth.simulation.goals import Progress

GOAL = "HOLDS(agent, milk) and ON(plate, table): 2"
CODES = ["listed", "triples"]


@pytest.fixture(scope="module")
def two(maple):
    return opening(maple, GOAL)


@pytest.fixture(scope="module")
def one(maple):
    return opening(maple, GOAL, agents=1)


class Chance:
    """A partner that does anything."""

    def reset(self, observation, goal, seed):
        self.chooser, self.goal = random.Random(seed), goal

    def act(self, observation, legal):
        return self.chooser.choice(list(legal))


@pytest.mark.parametrize("code", CODES)
def test_pettingzoo_accepts_it(two, code):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(ParallelHome(Setting(two, code=code)), num_cycles=60)
    parallel_seed_test(lambda: ParallelHome(Setting(two, code=code)), num_cycles=20)


def test_pettingzoo_accepts_it_in_turns(two):
    class Module:
        parallel_env = staticmethod(lambda max_cycles: pettingzoo_env.parallel_env(two, max_cycles))
        env = staticmethod(lambda max_cycles: pettingzoo_env.env(two, max_cycles))

    max_cycles_test(Module)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Observation (is not|space for)")  # it is a dict of arrays
        api_test(pettingzoo_env.env(two), num_cycles=20)
        seed_test(lambda: pettingzoo_env.env(two), num_cycles=10)


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("mode", [None, "rgb_array", "ansi"])
def test_gymnasium_accepts_it(one, code, mode):
    env = HomeEnv(Setting(one, code=code), render_mode=mode)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*not having a spec.*")
        check_env(env)


def test_gymnasium_makes_it_in_every_render_mode(one):
    spec = gymnasium.envs.registration.EnvSpec(
        "hearth/Home-v0", HomeEnv, max_episode_steps=250, kwargs={"setting": Setting(one)}
    )
    env = gymnasium.make(spec, render_mode="ansi")
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*is different from the unwrapped.*")
        check_env(env.unwrapped)


def test_several_at_once_are_the_same_as_one_by_one(one):
    def make():
        return HomeEnv(Setting(one, limit=5))

    several = gymnasium.vector.SyncVectorEnv([make] * 3)
    alone = [make() for _ in range(3)]
    seen, _ = several.reset(seed=7)
    begun = [env.reset(seed=7 + number)[0] for number, env in enumerate(alone)]
    for actions in ([1, 2, 3], [0, 5, 1], [2, 2, 2]):
        assert all(np.array_equal(seen[name][n], each[name]) for n, each in enumerate(begun) for name in each)
        seen, rewards, *_, infos = several.step(np.array(actions))
        stepped = [env.step(action) for env, action in zip(alone, actions, strict=True)]
        begun = [each[0] for each in stepped]
        assert rewards.tolist() == pytest.approx([each[1] for each in stepped])
        assert infos["legal"].tolist() == [each[4]["legal"] for each in stepped]


def test_an_episode_is_cut_off_and_its_rewards_add_up(two):
    env = ParallelHome(Setting(two, limit=6))
    env.reset(seed=1)
    total = 0.0
    for tick in range(6):
        _, rewards, terminated, truncated, _ = env.step({"agent_0": 0})
        total += rewards["agent_1"]
        assert not any(terminated.values()) and set(truncated.values()) == {tick == 5}
    assert total == pytest.approx(6 * -0.004) and env.agents == []
    assert env.step({}) == ({}, {}, {}, {}, {})
    assert len(env.reset()[0]) == 2


def walk_and_grab(env, name: str) -> list[float]:
    """Reach HOLDS(agent, NAME) by words, if it is seen or in another room; the rewards."""
    rewards = []
    for _ in range(60):
        texts = env.texts()
        wanted = [n for n, text in enumerate(texts) if text.startswith(f"[Grab] <{name}>")]
        wanted = wanted or [n for n, text in enumerate(texts) if text.startswith("[Open] <fridge>")]
        wanted = wanted or [n for n, text in enumerate(texts) if text.startswith("[Walktowards] <fridge>")]
        wanted = wanted or [n for n, text in enumerate(texts) if text.startswith("[Walktowards] <kitchen>")]
        _, reward, terminated, _, _ = env.step(wanted[0])
        rewards.append(reward)
        if terminated:
            return rewards
    raise AssertionError("not reached")


@pytest.mark.parametrize("told", [None, frozenset()])
def test_a_goal_is_reached_by_the_words_of_its_actions(maple, told):
    begin = opening(maple, "HOLDS(agent, milk)", agents=1)
    env = HomeEnv(Setting(begin, told=told))
    observation, _ = env.reset(seed=4)
    assert bool(observation["goal"].any()) == (told is None)
    rewards = walk_and_grab(env, "milk")
    assert rewards[-1] == pytest.approx(1 - 0.004) and rewards[:-1] == pytest.approx([-0.004] * (len(rewards) - 1))
    assert env.session.info(0)["success"] and env.session.progress.fraction == 1
    assert Episode.of(env.session.env).verify() is None


def test_other_rewards(maple):
    begin = opening(maple, "HOLDS(agent, milk)", agents=1)
    env = HomeEnv(Setting(begin, rewards=HIERARCHICAL))
    env.reset(seed=4)
    rewards = walk_and_grab(env, "milk")
    assert sum(rewards) == pytest.approx(2 - 0.1 * len(rewards))
    env = HomeEnv(Setting(begin, rewards=Rewards(0.0, 0.0, 0.0, 1.0)))
    env.reset(seed=4)
    left = metres_left(env.session.progress, env.session.env.world, 0)
    assert left > 2 and sum(walk_and_grab(env, "milk")) == pytest.approx(left)


def test_approach_goes_towards_the_thing_and_then_the_place(maple):
    begin = opening(maple, "ON(milk, sofa)", agents=1)
    world, goal = begin(1)
    progress = Progress.start(goal, world)
    far = metres_left(progress, world, 0)
    env = HomeEnv(Setting(opening(maple, "HOLDS(agent, milk)", agents=1)))
    env.reset(seed=1)
    env.session._begin(world, Progress.start(env.session.progress.goal, world).goal)
    walk_and_grab(env, "milk")
    held = env.session.env.world
    assert held.holding()[0] and 0 < metres_left(Progress.start(goal, held), held, 0) < far


def test_partners_act_and_are_told_what_they_may_know(maple):
    begin = opening(maple, GOAL, agents=2, strides=(1.0, 3.0))
    partner = Chance()
    env = HomeEnv(Setting(begin, told=frozenset({0})), [partner])
    observation, _ = env.reset(seed=1)
    assert partner.goal is None and observation["goal"].any()
    assert env.session.env.world.agents[1].stride == 3.0
    for _ in range(5):
        env.step(0)
    assert all(set(tick.instructions) == {1} for tick in env.session.env.ticks)
    first = [str_step(tick.instructions[1]) for tick in env.session.env.ticks]
    env.reset(seed=1)
    for _ in range(5):
        env.step(0)
    assert [str_step(tick.instructions[1]) for tick in env.session.env.ticks] == first


@pytest.mark.parametrize(
    ("actions", "code"),
    [
        ({"agent_7": 0}, Code.UNKNOWN_AGENT),
        ({5: 0}, Code.UNKNOWN_AGENT),
        ({"agent_0": -1}, Code.BAD_ARGUMENT),
        ({"agent_0": 1, "agent_1": 10**9}, Code.BAD_ARGUMENT),
        ({"agent_0": 1, "agent_1": "Walk"}, Code.BAD_ARGUMENT),
        ({"agent_0": 1, "agent_1": None}, Code.BAD_ARGUMENT),
        ({"agent_0": 1, "agent_1": 0.5}, Code.BAD_ARGUMENT),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_of_it_done(two, actions, code):
    env = ParallelHome(Setting(two))
    before, _ = env.reset(seed=1)
    world = env.session.env.world
    with pytest.raises(HearthError) as refused:
        env.step(actions)
    assert refused.value.diagnostics[0].code is code
    assert env.session.env.world is world and not env.session.env.ticks
    assert data_equivalence(env._observed(), before, exact=True)


def test_what_fails_says_why_and_the_other_goes_on(two):
    env = ParallelHome(Setting(two, code="triples"))
    env.reset(seed=1)
    names = env.session.names
    unseen = next(slot for slot, seen in enumerate(env._observed()["agent_0"]["seen"]) if not seen)
    grab, turn = 1 + names.index("Grab"), 1 + names.index("Turnleft")
    before = env.session.env.world
    *_, infos = env.step({"agent_0": [grab, unseen, 0], "agent_1": [turn, 0, 0]})
    failure = infos["agent_0"]["failure"]
    assert (failure.code, failure.actual, infos["agent_1"]["failure"]) == (Code.UNBOUND, "not seen", None)
    assert env.session.env.world.agents[0] == before.agents[0]
    assert env.session.env.world.agents[1].pose.yaw == (before.agents[1].pose.yaw - 30) % 360
    *_, infos = env.step({"agent_0": [1 + names.index("PutBack"), 0, 0], "agent_1": [grab, 767, 0]})
    assert infos["agent_0"]["failure"].code is Code.WRONG_ARITY
    assert infos["agent_1"]["failure"].code is Code.UNBOUND
    *_, infos = env.step({"agent_0": [1 + names.index("StandUp"), 0, 0]})
    assert infos["agent_0"]["failure"].code is Code.NOT_SITTING_OR_LYING and infos["agent_1"]["failure"] is None


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda begin: HomeEnv(Setting(begin)), "0 partners of agent 0, where there are 2 agents"),
        (lambda begin: HomeEnv(Setting(begin), [Chance()], learner=4), "partners of agent 4"),
        (lambda begin: ParallelHome(Setting(begin), render_mode="human"), "no render mode `human`"),
        (lambda begin: ParallelHome(Setting(begin), camera="drone"), "no camera `drone`"),
        (lambda begin: ParallelHome(Setting(begin, code="words")), "no code of actions"),
        (lambda begin: ParallelHome(Setting(begin, actions=("Fly",))), "`Fly` is not a known action"),
    ],
)
def test_settings_that_cannot_be_are_refused(two, make, message):
    with pytest.raises(HearthError, match=message):
        make(two)


def test_a_plan_shows_the_agents_and_lines_say_what_they_did(two):
    env = ParallelHome(Setting(two), render_mode="rgb_array")
    env.reset(seed=1)
    one = env.render()
    assert one.dtype == np.uint8 and one.ndim == 3
    blue = np.array([0x3F, 0x6F, 0xD1])
    assert 200 < (one == blue).all(axis=-1).sum() < 800
    for _ in range(3):
        env.step({"agent_0": env.texts("agent_0").index("[Walkforward]") if "[Walkforward]" in env.texts("agent_0")
                  else env.texts("agent_0").index("[Turnleft]")})  # fmt: skip
    assert (env.render() != one).any()
    env = ParallelHome(Setting(two), render_mode="ansi")
    env.reset(seed=1)
    env.step({"agent_0": env.texts("agent_0").index("[Turnleft]")})
    lines = env.render().splitlines()
    assert lines[0].startswith("tick 1 of 250: HOLDS(agent, milk)") and lines[1].endswith("[Turnleft]")
    assert lines[2].endswith("wait")
    assert ParallelHome(Setting(two)).render() is None


def test_a_camera_takes_pictures(one):
    pytest.importorskip("open3d", reason="pictures need open3d")
    env = HomeEnv(Setting(one), render_mode="rgb_array", camera="first")
    env.reset(seed=1)
    first = env.render()
    env.step(env.texts().index("[Turnleft]"))
    assert first.shape == env.render().shape and (first != env.render()).any()


def test_a_fixed_list_of_actions(maple):
    begin = opening(maple, "HOLDS(agent, milk)", agents=1)
    things = ("kitchen", "fridge", "milk")
    probe = HomeEnv(Setting(begin, things=things))
    code = fixed_list(("Walktowards", "Open", "Grab"), probe.session.rows.slots)
    env = HomeEnv(Setting(begin, actions=("Walktowards", "Open", "Grab"), things=things, code=code, partial=False))
    env.reset(seed=2)
    order = [str_step(step) for step in code.steps]
    fridge, opened = order.index("[Walktowards] <fridge> (0.137)") + 1, order.index("[Open] <fridge> (0.137)") + 1
    info = {"failure": None}
    for _ in range(30):
        observation, *_, info = env.step(opened if observation_allows(env, opened) else fridge)
        if env.session.env.world.has_state(137, "OPEN"):
            break
    assert info["failure"] is None and env.session.env.world.has_state(137, "OPEN")
    assert observation["action_mask"].sum() > 1


def observation_allows(env, number: int) -> bool:
    return bool(env.session.observe(0)["action_mask"][number])


SCRIPT = """
import hashlib, hearth
from hearth.envs.pettingzoo_env import ParallelHome
from hearth.envs.session import Setting, opening
env = ParallelHome(Setting(opening(hearth.home("maple"), "HOLDS(agent, milk)")))
digest = hashlib.sha256()
observations, _ = env.reset(seed=3)
for tick in range(25):
    for name, arrays in sorted(observations.items()):
        for key in sorted(arrays):
            digest.update(key.encode() + arrays[key].tobytes())
    chosen = {name: int(7 * tick + 3) % int(arrays["action_mask"].sum()) for name, arrays in observations.items()}
    observations, *_ = env.step(chosen)
print(digest.hexdigest())
"""


def test_arrays_are_the_same_bytes_in_every_process():
    def digest(seed: str) -> str:
        done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=True,
                              env={"PYTHONHASHSEED": seed, "PATH": ""})  # fmt: skip
        return done.stdout.strip()

    assert digest("1") == digest("2") != ""


def test_a_step_before_the_first_reset_is_a_fault(one):
    env = HomeEnv(Setting(one))
    with pytest.raises(HearthError, match=r"`step` came before the first `reset`.*call `reset\(\)`") as caught:
        env.step(0)
    assert caught.value.diagnostics[0].code == Code.OUT_OF_ORDER
    env.reset(seed=1)
    env.step(0)
