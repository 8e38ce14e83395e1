"""The environment in TRL itself: one GRPO step of a tiny random model, rewards of the engine, seeds, bad input."""

from typing import ClassVar

import pytest
import torch
from hearth_trl import HearthEnv, rows
from tokenizers import Tokenizer, models, pre_tokenizers, trainers
from transformers import PreTrainedTokenizerFast, Qwen3Config, Qwen3ForCausalLM
from trl import GRPOConfig, GRPOTrainer
from trl.chat_template_utils import qwen3_chat_template

import hearth
from datasets import Dataset

HOLD = {"home": "maple", "goal": "HOLDS(agent, milk)"}
MILK = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")


def tokenizer():
    """A tokenizer of bytes with the marks of the chat template, made here: nothing is fetched."""
    made = Tokenizer(models.BPE())
    made.pre_tokenizer = pre_tokenizers.ByteLevel(add_prefix_space=False)
    marks = ["<|endoftext|>", "<|im_start|>", "<|im_end|>"]
    trainer = trainers.BpeTrainer(
        vocab_size=400, special_tokens=marks, initial_alphabet=pre_tokenizers.ByteLevel.alphabet(), show_progress=False
    )
    made.train_from_iterator([hearth.TextHome(**{"task": "maple", "goal": HOLD["goal"]}).instructions], trainer)
    from tokenizers import decoders

    made.decoder = decoders.ByteLevel()
    found = PreTrainedTokenizerFast(tokenizer_object=made, eos_token="<|im_end|>", pad_token="<|endoftext|>")
    found.chat_template = qwen3_chat_template
    return found


def model(size):
    torch.manual_seed(0)
    shape = {"hidden_size": 16, "intermediate_size": 32, "num_hidden_layers": 1, "num_attention_heads": 2}
    config = Qwen3Config(vocab_size=size, num_key_value_heads=1, head_dim=8, max_position_embeddings=8192, **shape)
    return Qwen3ForCausalLM(config)


class Playing(HearthEnv):
    """An environment that plays its commands itself before it is scored: a random model calls no tool.

    Every second one gives up early, so that a group has something to learn from.
    """

    made: ClassVar[list] = []

    def __init__(self):
        super().__init__()
        self._commands = MILK[: 4 - 2 * (len(Playing.made) % 2)]
        self._scores = []
        Playing.made.append(self)

    def reset(self, **row):
        self._seed = row["seed"]
        return super().reset(**row)

    def get_reward(self):
        for command in self._commands:
            if not self._episode.turn.done:
                HearthEnv.act(self, command)
        self._scores.append((self._seed, super().get_reward()))
        return self._scores[-1][1]


def trained(tmp_path, factory):
    words = tokenizer()
    config = GRPOConfig(
        output_dir=str(tmp_path), per_device_train_batch_size=4, num_generations=2, max_completion_length=8,
        max_steps=1, report_to=[], use_cpu=True, save_strategy="no", logging_steps=1, learning_rate=0.1,
        shuffle_dataset=False, max_tool_calling_iterations=2, disable_tqdm=True, bf16=False, beta=0.0,
    )  # fmt: skip
    data = Dataset.from_list([{**row, "seed": 4 + n} for n, row in enumerate(rows(4, **HOLD, limit=60))])
    made = model(len(words))
    before = {name: value.clone() for name, value in made.state_dict().items()}
    trainer = GRPOTrainer(
        model=made, args=config, train_dataset=data, processing_class=words, environment_factory=factory
    )
    trainer.train()
    moved = any(not torch.equal(before[name], value) for name, value in made.state_dict().items())
    return trainer, moved


def test_one_grpo_step_with_the_rewards_of_the_engine(tmp_path):
    Playing.made.clear()
    trainer, moved = trained(tmp_path, Playing)
    scores = [score for env in Playing.made for score in env._scores]
    for env in Playing.made:
        for seed, reward in env._scores:
            episode = hearth.TextEpisode(**HOLD, limit=60)
            turn = episode.reset(seed)
            for command in env._commands:
                turn = turn if turn.done else episode.step(command)
            assert reward == turn.goal_fraction
    assert len(scores) == 4 and {reward for _, reward in scores} == {0.0, 1.0}
    log = next(entry for entry in trainer.state.log_history if "reward" in entry)
    assert log["reward"] == log["rewards/Playing/mean"] == pytest.approx(sum(reward for _, reward in scores) / 4)
    assert moved, "the step changes the model"
    assert [tool.__name__ for tool in trainer.tools] == ["act"]


def test_the_environment_is_the_engine():
    env, episode = HearthEnv(), hearth.TextEpisode(**HOLD)
    assert env.reset(seed=4, **HOLD) == episode.reset(4).observation
    for command in MILK:
        assert env.act(command) == episode.step(command).observation
    assert env.get_reward() == 1.0


def test_seeds_repeat_and_sixty_four_stand_beside_each_other():
    envs = [HearthEnv() for _ in range(64)]
    first = [env.reset(seed=number % 32, **HOLD) for number, env in enumerate(envs)]
    assert first[:32] == first[32:] and len(set(first)) == 4
    after = [env.act("Walk kitchen") for env in envs]
    assert after[:32] == after[32:]
    assert [env.get_reward() for env in envs] == [0.0] * 64


def test_a_tool_call_out_of_order_or_wrong_is_an_error_that_the_model_reads():
    env = HearthEnv()
    with pytest.raises(ValueError, match="OUT_OF_ORDER"):
        env.act("wait")
    assert env.get_reward() == 0.0
    env.reset(seed=1, **HOLD, limit=2)
    assert "refused" in env.act(7)
    env.act("wait")
    with pytest.raises(hearth.HearthError, match="OUT_OF_ORDER"):
        env.act("wait")


@pytest.mark.parametrize(
    "row", [{"seed": -1}, {"seed": "1"}, {"seed": 1.5}, {"home": "castle", "goal": "x"}, {"home": "maple"}]
)
def test_a_wrong_row_is_refused(row):
    with pytest.raises(hearth.HearthError):
        HearthEnv().reset(**row)


def test_fields_of_other_columns_are_left_alone():
    assert HearthEnv().reset(seed=2, **HOLD, prompt=[], extra=3).startswith("Goal")
