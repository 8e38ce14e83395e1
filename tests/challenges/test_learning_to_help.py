"""Policies that help: they learn by heart, draw the same for any batch, survive a checkpoint, and what is rewarded."""

from __future__ import annotations

import math
from random import Random

import pytest

torch = pytest.importorskip("torch")

from hearth.agents.hierarchical_helper import Hierarchical  # noqa: E402
from hearth.agents.human_like import HumanLike  # noqa: E402
from hearth.agents.learned_helpers import Hybrid, Learned  # noqa: E402
from hearth.agents.policy_observations import vocabulary  # noqa: E402
from hearth.analysis.training_curves import drawn, runs  # noqa: E402
from hearth.challenges import learning_to_help  # noqa: E402
from hearth.challenges.learning_to_help import (  # noqa: E402
    Effort,
    Lesson,
    _aims_of,
    beside,
    high_rewards,
    learn,
    lesson,
)
from hearth.challenges.published_tasks import tasks  # noqa: E402
from hearth.kb.loading.load import default  # noqa: E402
from hearth.models.checkpoint import load, save  # noqa: E402
from hearth.models.helping import actor_critic  # noqa: E402
from hearth.models.helping.policies import HelpingPolicy, untrained  # noqa: E402
from hearth.models.helping.policy_inputs import KINDS, packed  # noqa: E402
from hearth.models.interface import Training  # noqa: E402

TASKS = tasks("wah", "train", limit=4)


@pytest.fixture(scope="module")
def words():
    return vocabulary([_aims_of(task, default) for task in TASKS])


@pytest.fixture(scope="module")
def lessons(words):
    return [lesson(Lesson(task, words, default)) for task in TASKS]


def chosen(lessons, chooses):
    return [trace for each in lessons for trace in each[chooses == "actions"]]


def test_before_training_every_choice_is_about_as_probable(words, lessons):
    traces = chosen(lessons, "subgoals")
    network = untrained("subgoals", words, 0).network
    seen = network(packed(traces))
    uniform = math.log(len(words.things)) + math.log(len(words.places))
    assert actor_critic.entropy(seen).mean().item() == pytest.approx(uniform, rel=0.1)


@pytest.mark.parametrize("chooses", ["subgoals", "actions"])
def test_a_few_choices_are_learnt_by_heart(words, lessons, chooses):
    batch = packed(chosen(lessons, chooses)[:6])
    policy = untrained(chooses, words, 0)
    optimiser = torch.optim.Adam(policy.network.parameters(), 3e-3)
    policy.network.train()
    for _ in range(60):
        loss = actor_critic.imitation(policy.network, batch)
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    seen = policy.network(batch)
    right = actor_critic._chosen(seen, batch)[torch.as_tensor(batch.there)].exp().mean()
    assert right > 0.6


def test_what_is_padded_changes_nothing(words, lessons):
    traces = chosen(lessons, "actions")
    network = untrained("actions", words, 1).network.eval()
    alone, together = packed(traces[:1]), packed(traces)
    length = int(alone.there.sum())
    with torch.no_grad():
        one, all_of_them = network(alone), network(together)
    nodes = alone.classes.shape[2]
    assert torch.allclose(one.first[0, :length], all_of_them.first[0, :length], atol=1e-4)
    assert torch.allclose(one.value[0, :length], all_of_them.value[0, :length], atol=1e-4)
    able = torch.as_tensor(alone.legal[0, :length]).any(-1)
    second = all_of_them.second[0, :length, :, :nodes]
    assert torch.allclose(one.second[0, :length][able].exp(), second[able].exp(), atol=1e-4)


def test_only_what_can_be_done_is_chosen(words, lessons):
    policy = untrained("actions", words, 0)
    for trace in chosen(lessons, "actions")[:4]:
        for scene in trace.scenes[:8]:
            (kind, node), _ = policy.choose(scene, None, Random(1))
            assert scene.legal[kind][node], KINDS[kind]


def test_returns_are_discounted_rewards():
    assert actor_critic.discounted([1.0, 0.0, 4.0], [0, 2], 0.5) == [2.0, 4.0]
    assert actor_critic.discounted([], [0], 0.5) == [0.0]


def test_advantages_raise_what_came_out_well(words, lessons):
    """Of two equal scenes with different choices, that with the higher return becomes more probable."""
    (trace, *_) = chosen(lessons, "subgoals")
    scene = trace.scenes[0]
    batch = packed([trace._replace(scenes=(scene,), choices=((i, 0),), returns=(float(10 * i),)) for i in (0, 1)])
    network = untrained("subgoals", words, 0).network
    before = network(batch).first[0, 0].detach()
    optimiser = torch.optim.SGD(network.parameters(), 0.05)
    actor_critic.actor_critic(network, batch).backward()
    optimiser.step()
    after = network(batch).first[0, 0].detach()
    assert after[1] - before[1] > after[0] - before[0]


def test_rewards_are_those_of_the_appendix():
    """2 for each predicate, whoever brings it about, and -0.1 for each tick (B.3.3)."""
    task = TASKS[0]
    done = beside(task, main := HumanLike(), Hierarchical(main), default, 0)
    assert done.success
    wanted = sum(count for _, count in task.goal)
    assert sum(high_rewards(done)) == pytest.approx(2 * wanted - 0.1 * done.ticks)


@pytest.mark.parametrize("kind", [Hybrid, Learned])
def test_a_helper_that_has_learnt_nothing_plays_and_repeats_itself(words, kind):
    policies = [untrained(name, words, 0) for name in ("subgoals", "actions")][: 1 + (kind is Learned)]
    runs = [beside(TASKS[1], HumanLike(), kind(*policies), default, 3).env.ticks for _ in range(2)]
    assert [tick.instructions for tick in runs[0]] == [tick.instructions for tick in runs[1]]
    assert any(1 in tick.instructions for tick in runs[0])


@pytest.mark.parametrize("chooses", ["subgoals", "actions"])
def test_a_training_is_repeated_and_kept(tmp_path, chooses):
    effort = Effort(imitation=2, epochs=1, updates=1, episodes=1)
    one, two = (learn("wah", chooses, default, Training(seed=5), effort, limit=4) for _ in range(2))
    save(one.checkpoint(), tmp_path / "made")
    save(two.checkpoint(), tmp_path / "again")
    weights = [(tmp_path / name / "weights.safetensors").read_bytes() for name in ("made", "again")]
    assert weights[0] == weights[1]
    back = HelpingPolicy.restored(load(tmp_path / "made"))
    assert back.words == one.words and back.settings == one.settings
    assert back.facts["episodes"] == 1 and len(back.facts["curves"]["score"]) == 1
    (run,) = runs([tmp_path / "made"])
    assert (run.seed, [len(scores) for scores in run.scores.values()]) == (5, [2, 2])
    assert drawn([run, run]).count("<polyline") == 4
    assert "helps somebody" in (tmp_path / "made" / "README.md").read_text()


@pytest.mark.parametrize("gain", [-1.0, 1.0])
def test_what_was_imitated_stays_where_practice_earns_no_more(monkeypatch, gain):
    """Practice that sets all weights to 0, and earns less or more."""
    kept = {}

    def practise(policy, *rest):
        kept.update({name: value.clone() for name, value in policy.network.state_dict().items()})
        for value in policy.network.state_dict().values():
            value.zero_()
        return {"epochs": 1, "curves": {"score": [gain]}}

    monkeypatch.setattr(learning_to_help, "_practise", practise)
    monkeypatch.setattr(learning_to_help, "_score", lambda rollout, tasks: 0.0)
    effort = Effort(imitation=1, epochs=1, updates=1, episodes=1)
    policy = learn("wah", "subgoals", default, Training(seed=5), effort, limit=2)
    same = all(torch.equal(kept[name], value) for name, value in policy.network.state_dict().items())
    assert same == (gain < 0) and policy.facts["kept"] == ("imitation" if gain < 0 else "practice")
