"""Loops of learners over our environments: PPO in the style of CleanRL, by torch alone, and Stable-Baselines3's."""

from __future__ import annotations

import pytest

pytest.importorskip("gymnasium", reason="the extra `agents` is not installed")
pytest.importorskip("torch", reason="the extra `models` is not installed")

import gymnasium as gym
import numpy as np
import torch
from gymnasium.wrappers import FlattenObservation

from hearth.challenges.named_task_envs import register
from hearth.envs.rewards import Rewards

register()

THIN = {
    "home": "maple", "goal": "HOLDS(agent, milk)", "code": "fixed", "limit": 12,
    "actions": ["Grab", "Open", "Walktowards"], "things": ["kitchen", "fridge", "milk"],
    "sizes": {"nodes": 16, "edges": 32}, "arrays": ["seen", "states", "close", "hands", "action_mask"],
    "rewards": Rewards(success=1.0, tick=-0.02, approach=0.02),
}  # fmt: skip


def environments(mode):
    return gym.make_vec("hearth/Home-v0", num_envs=2, vectorization_mode=mode, wrappers=(FlattenObservation,), **THIN)


def ppo(mode, steps=16, updates=2):
    """PPO in one function, as CleanRL has it: collect steps of many environments, then fit policy and value."""
    torch.manual_seed(0)
    torch.set_num_threads(1)
    envs = environments(mode)
    size, actions = envs.single_observation_space.shape[0], int(envs.single_action_space.n)
    body = torch.nn.Sequential(torch.nn.Linear(size, 32), torch.nn.Tanh())
    policy, value = torch.nn.Linear(32, actions), torch.nn.Linear(32, 1)
    parts = [*body.parameters(), *policy.parameters(), *value.parameters()]
    adam = torch.optim.Adam(parts, lr=1e-3)
    observation, _ = envs.reset(seed=1)
    losses, rewards = [], []
    try:
        for _ in range(updates):
            seen, chosen, logs, values, earned, ends = [], [], [], [], [], []
            for _ in range(steps):
                now = torch.as_tensor(np.asarray(observation, np.float32))
                hidden = body(now)
                drawn = torch.distributions.Categorical(logits=policy(hidden))
                act = drawn.sample()
                seen.append(now), chosen.append(act), logs.append(drawn.log_prob(act).detach())
                values.append(value(hidden).squeeze(-1).detach())
                observation, reward, terminated, truncated, _ = envs.step(act.numpy())
                earned.append(torch.as_tensor(reward, dtype=torch.float32))
                ends.append(torch.as_tensor(terminated | truncated, dtype=torch.float32))
            advantage, after = torch.zeros(2), torch.zeros(2)
            gains = []
            for n in reversed(range(steps)):
                error = earned[n] + 0.97 * after * (1 - ends[n]) - values[n]
                advantage = error + 0.97 * 0.95 * (1 - ends[n]) * advantage
                gains.append(advantage)
                after = values[n]
            gain = torch.stack(gains[::-1])
            target = gain + torch.stack(values)
            hidden = body(torch.stack(seen))
            drawn = torch.distributions.Categorical(logits=policy(hidden))
            ratio = (drawn.log_prob(torch.stack(chosen)) - torch.stack(logs)).exp()
            clipped = torch.minimum(ratio * gain, ratio.clamp(0.8, 1.2) * gain).mean()
            loss = -clipped + 0.5 * (value(hidden).squeeze(-1) - target).pow(2).mean() - 0.01 * drawn.entropy().mean()
            adam.zero_grad()
            loss.backward()
            adam.step()
            losses.append(float(loss.detach()))
            rewards.append(torch.stack(earned).sum().item())
    finally:
        envs.close()
    return losses, rewards


def test_a_loop_as_cleanrl_has_it_learns_from_many_environments():
    losses, rewards = ppo("sync")
    assert len(losses) == 2 and all(np.isfinite(losses)) and all(np.isfinite(rewards))
    assert ppo("sync") == (losses, rewards)


def test_it_is_the_same_in_processes():
    assert ppo("async") == ppo("sync")


@pytest.mark.tools
def test_stable_baselines_learns():
    baselines = pytest.importorskip("stable_baselines3", reason="stable-baselines3 is not installed")
    env = FlattenObservation(gym.make("hearth/Home-v0", **THIN))
    model = baselines.PPO("MlpPolicy", env, n_steps=16, batch_size=16, seed=0)
    before = [each.clone() for each in model.policy.parameters()]
    model.learn(32)
    assert any((old != new).any() for old, new in zip(before, model.policy.parameters(), strict=True))
    observation, _ = env.reset(seed=1)
    assert env.action_space.contains(int(model.predict(observation)[0]))
