"""`hearth.ArrayHomes` as a vector environment of Gymnasium, with tensors of torch, and with two agents."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip("numba")
gymnasium = pytest.importorskip("gymnasium")

import hearth  # noqa: E402
from hearth.challenges.array_homes import parallel_array_homes  # noqa: E402
from hearth.challenges.household import household_tasks  # noqa: E402
from hearth.challenges.named_task_envs import watch_and_help_env  # noqa: E402
from hearth.challenges.published_tasks import tasks  # noqa: E402
from hearth.envs.rewards import Rewards  # noqa: E402
from hearth.schemas.diagnostics import HearthError  # noqa: E402

WAH = tuple(task for task in tasks("wah", "train", limit=40) if task.home != "maple")[:6]
"""Tasks in homes of one bucket, so that kernels are compiled once."""


@pytest.fixture(scope="module")
def homes():
    return hearth.ArrayHomes(WAH, worlds=16, limit=20)


def legal(observation, rng, key="mask"):
    """A random legal number of each world."""
    sums = observation[key].cumsum(axis=1, dtype=np.uint16)
    chosen = (rng.random(len(sums)) * sums[:, -1]).astype(np.uint16)
    return (sums <= chosen[:, None]).sum(axis=1)


def test_it_is_a_vector_environment(homes):
    assert isinstance(homes, gymnasium.vector.VectorEnv) and homes.num_envs == 16
    observation, infos = homes.reset(seed=3)
    assert homes.observation_space.contains(observation) and infos == {}
    observation, rewards, terminated, truncated, infos = homes.step(homes.action_space.sample())
    assert homes.observation_space.contains(observation)
    assert rewards.shape == terminated.shape == truncated.shape == (16,) and terminated.dtype == truncated.dtype == bool
    assert infos["refused"].shape == (16,) and homes.metadata["autoreset_mode"].value == "SameStep"


def test_every_number_of_the_space_can_be_given(homes):
    """Those between actions without objects and the others are refused as illegal ones are, for one tick."""
    homes.reset(seed=3)
    before = homes.worlds.arrays(0)["places"].copy()
    first = homes.worlds.batch.table.first_plane
    gap = np.arange(first, 64)
    assert len(gap)
    for number in (gap[0], gap[-1]):
        observation, rewards, _, _, infos = homes.step(np.full(16, number))
        assert infos["refused"].all() and (rewards < 0).all() and not observation["mask"][:, number].any()
    np.testing.assert_array_equal(observation["places"], before)
    homes.action_space.seed(0)
    for _ in range(30):
        homes.step(homes.action_space.sample())


def test_wrappers_of_gymnasium_count_returns_and_lengths(homes):
    env = gymnasium.wrappers.vector.RecordEpisodeStatistics(homes)
    observation, _ = env.reset(seed=3)
    rng = np.random.default_rng(0)
    for _ in range(20):
        observation, _, _, truncated, infos = env.step(legal(observation, rng))
    assert truncated.all() and infos["episode"]["l"].tolist() == [20] * 16
    assert infos["episode"]["r"] == pytest.approx([-0.08] * 16)


def test_an_episode_that_ends_begins_anew_in_the_same_step(homes):
    observation, _ = homes.reset(seed=5)
    rng = np.random.default_rng(0)
    for _ in range(19):
        observation, _, _, _, infos = homes.step(legal(observation, rng))
    assert "final_obs" not in infos
    observation, _, _, truncated, infos = homes.step(legal(observation, rng))
    assert truncated.all() and (observation["time"] == 0).all()
    assert homes.single_observation_space.contains(infos["final_obs"][3]) and infos["final_obs"][3]["time"][0] == 1
    assert infos["_final_obs"].all() and not infos["final_info"]["success"].any()


def test_the_same_seed_gives_the_same_episodes(homes):
    def run():
        observation, _ = homes.reset(seed=7)
        rng = np.random.default_rng(1)
        found = []
        for _ in range(25):
            observation, rewards, *_ = homes.step(legal(observation, rng))
            found.append((observation["mask"].sum(), observation["agents"].sum(), rewards.sum()))
        return found

    assert run() == run()


def test_rewards_and_ends_are_those_of_the_environment_of_one_world(homes):
    """The expert's way in `HomeEnv` is as long and worth as much as in arrays."""
    env = watch_and_help_env(limit_tasks=1, code="triples")
    _, _ = env.reset(seed=1)
    arrays = hearth.ArrayHomes(tasks("wah", "train", limit=1), worlds=2, limit=20)
    arrays.reset(seed=1)
    rng = np.random.default_rng(4)
    observation = arrays.worlds.arrays(0)
    for _ in range(20):
        numbers = np.repeat(legal(observation, rng)[:1], 2)
        step = arrays.instruction(0, int(numbers[0]))
        expected = env.session.act({0: step})[0]
        observation, rewards, terminated, _, _ = arrays.step(numbers)
        assert rewards.tolist() == [expected] * 2 and terminated.tolist() == [env.session.succeeded] * 2


def test_random_actions_are_legal_and_reach_all(homes):
    observation, _ = homes.reset(seed=3)
    drawn = np.array([homes.random_actions(seed) for seed in range(300)])
    assert (observation["mask"][np.arange(16)[None], drawn] == 1).all()
    assert len(np.unique(drawn[:, 0])) > 0.7 * observation["mask"][0].sum() and (drawn[0] != drawn[1]).any()


def test_tensors_share_the_memory(homes):
    pytest.importorskip("torch")
    observation, _ = homes.reset(seed=3)
    tensors = homes.tensors()
    assert all(tensors[name].data_ptr() == observation[name].ctypes.data for name in observation)
    before = tensors["agents"].clone()
    for _ in range(3):
        homes.step(legal(homes.worlds.arrays(0), np.random.default_rng(0)))
    assert (tensors["agents"] != before).any()


def test_copies_stay_as_they_are():
    homes = hearth.ArrayHomes(WAH[:2], worlds=2, copy=True)
    first, _ = homes.reset(seed=3)
    kept = {name: array.copy() for name, array in first.items()}
    homes.step(legal(first, np.random.default_rng(0)))
    assert all(np.array_equal(kept[name], first[name]) for name in kept)


def test_two_agents_act_at_once():
    env = parallel_array_homes(WAH[:3], worlds=4, limit=15)
    observations, infos = env.reset(seed=2)
    assert env.agents == ["agent_0", "agent_1"] == sorted(observations) == sorted(infos)
    rng = np.random.default_rng(0)
    for number in range(15):
        actions = {name: legal(each, rng) for name, each in observations.items()}
        observations, rewards, terminated, truncated, infos = env.step(actions)
        assert all(env.observation_space(name).contains({k: v[0] for k, v in each.items()})
                   for name, each in observations.items())  # fmt: skip
        assert not terminated["agent_0"].any() and truncated["agent_1"].all() == (number == 14)
    assert rewards["agent_0"].tolist() == [-0.004] * 4 and set(infos["agent_0"]) == {"refused", "conflict"}
    with pytest.raises(HearthError, match="no agent is called `agent_7`"):
        env.step({"agent_7": np.zeros(4, int)})


@pytest.mark.parametrize("settings, message", [
    ({"worlds": 0}, "`worlds` is 0"),
    ({"threads": 0}, "`threads` is 0"),
    ({"tasks": []}, "no tasks to play"),
    ({"tasks": "fly"}, "no challenge `fly`"),
    ({"reward": Rewards(approach=1.0)}, "pay for the goal"),
    ({"color": 1}, "no setting is called `color`"),
])  # fmt: skip
def test_bad_settings_are_refused(settings, message):
    with pytest.raises(HearthError, match=message):
        hearth.ArrayHomes(**{"tasks": WAH[:1], "worlds": 2, **settings})


def test_steps_before_the_first_reset_and_out_of_range_are_refused():
    homes = hearth.ArrayHomes(WAH[:1], worlds=2)
    with pytest.raises(HearthError, match="before the first `reset`"):
        homes.step(np.zeros(2, int))
    homes.reset(seed=1)
    for wrong in (np.zeros(3, int), np.array([0, 10**6]), np.array([0.5, 0])):
        with pytest.raises(HearthError, match="actions are 2 integers"):
            homes.step(wrong)


def test_the_classes_of_nodes_have_words(homes):
    classes = homes.worlds.classes()
    assert len(classes) == len(WAH) and {"fridge", "character"} <= set(classes[0])


def test_importing_hearth_imports_no_numba():
    command = "import sys, hearth; print('numba' in sys.modules or 'gymnasium' in sys.modules)"
    assert (
        subprocess.run([sys.executable, "-c", command], capture_output=True, text=True, check=True).stdout == "False\n"
    )


def test_household_tasks_are_played_where_they_are_in_scope():
    some = list(household_tasks("train", 3))
    homes = hearth.ArrayHomes(some, worlds=3)
    observation, _ = homes.reset(seed=1)
    assert (observation["mask"][:, 0] == 1).all()
