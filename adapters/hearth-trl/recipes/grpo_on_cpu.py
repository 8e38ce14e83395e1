"""GRPO on tasks of `household` with a tiny model on the processor, by TRL and this package: figures before and after.

    python recipes/grpo_on_cpu.py [--steps 10] [--group 4] [--warm 200] [--seed 0]

Nothing is fetched: the tokenizer and the model, of a million weights, are made here. The model first learns from
dialogues to call the tool, with a command of the expert or a drawn one; GRPO then learns from the engine's rewards
alone. The figures are mean rewards of rollouts in the same few tasks that it is trained on, with an interval of 95 %:
of the model before both, between them, and after. They show that the parts work together, not that a model of this
size learns to keep house. With a model of yours, leave out `warmed`.
"""

import argparse
import json
import logging
import re
import tempfile
import time
import warnings
from collections import defaultdict
from random import Random
from statistics import fmean
from typing import Any, ClassVar

import torch
from hearth_trl import HearthEnv, rows
from tokenizers import Tokenizer, decoders, models, pre_tokenizers, trainers
from transformers import PreTrainedTokenizerFast, Qwen3Config, Qwen3ForCausalLM, set_seed
from transformers.trainer_callback import PrinterCallback
from transformers.utils import get_json_schema
from trl import GRPOConfig, GRPOTrainer
from trl.chat_template_utils import qwen3_chat_template

import hearth
from datasets import Dataset

SOURCE = {"tasks": "household:train:24", "limit": 100}

TASKS = 6
"""Tasks of the source: the first that the expert does in `TURNS` commands."""

TURNS = 7

RIGHTLY = 0.75
"""The share of right commands in the dialogues."""

DIALOGUES = 10
"""Of each task, in the warm-up."""

VOCABULARY = 3000

LONGEST = 768
"""Tokens of a rollout: calls and observations."""

RATE = 1e-4
"""The learning rate of GRPO. At 1e-3 ten steps lost what the warm-up had taught: the mean reward fell from .10 to 0."""

SHORT = 64
"""Tokens of a rollout of the untrained model, which calls nothing and finds no end; a call has some 15."""

ROLLOUTS = 4
"""Of each task, for a figure."""

ANSWERED = re.compile(r"<\|im_start\|>assistant\n(.*?<\|im_end\|>)", re.DOTALL)
"""The words of an assistant, with the mark of their end."""

Tokens = PreTrainedTokenizerFast


class Scored(HearthEnv):
    """An environment that writes its rewards down, by the seed of its row."""

    rewards: ClassVar[dict[int, list[float]]] = defaultdict(list)

    def reset(self, **row: Any) -> str:
        """Begin the world of a row."""
        self._seed = row["seed"]
        return super().reset(**row)

    def get_reward(self) -> float:
        """Return the part of the goal that was reached."""
        reward = super().get_reward()
        Scored.rewards[self._seed].append(reward)
        return reward


def short_tasks() -> list[int]:
    """Return the first seeds of different tasks that the expert does in a few commands."""
    found: dict[str, int] = {}
    episode, seed = hearth.TextEpisode(**SOURCE, expert=True), 0
    while len(found) < TASKS:
        turn = episode.reset(seed)
        for _ in range(TURNS):
            turn = turn if turn.done else episode.step(episode.expert)
        if turn.won:
            found.setdefault(turn.task, seed)
        seed += 1
    return list(found.values())


def dialogue(seed: int, prompt: str, chance: Random, rightly: float) -> list[dict]:
    """Return a dialogue in which each command is the expert's, or drawn from those that are possible."""
    episode = hearth.TextEpisode(**SOURCE, expert=True)
    turn = episode.reset(seed)
    messages = [{"role": "user", "content": prompt + turn.observation}]
    for _ in range(TURNS):
        command = episode.expert if chance.random() < rightly else chance.choice(list(episode.admissible))
        call = {"type": "function", "function": {"name": "act", "arguments": {"command": command}}}
        turn = episode.step(command)
        messages.append({"role": "assistant", "content": "", "tool_calls": [call]})
        messages.append({"role": "tool", "name": "act", "content": turn.observation})
        if turn.done:
            break
    return messages


def tokenizer(dialogues: list[list[dict]]) -> Tokens:
    """Return a tokenizer of dialogues, in which a line that comes often is one token: so a call is a few."""
    found = Tokens(tokenizer_object=Tokenizer(models.BPE()), eos_token="<|im_end|>", pad_token="<|endoftext|>")
    found.chat_template = qwen3_chat_template
    texts = [found.apply_chat_template(each, tools=tools(), tokenize=False) for each in dialogues]
    made = Tokenizer(models.BPE())
    lines = pre_tokenizers.Split("\n", "merged_with_previous")
    made.pre_tokenizer = pre_tokenizers.Sequence(
        [lines, pre_tokenizers.ByteLevel(add_prefix_space=False, use_regex=False)]
    )
    made.decoder = decoders.ByteLevel()
    marks = ["<|endoftext|>", "<|im_start|>", "<|im_end|>"]
    alphabet = pre_tokenizers.ByteLevel.alphabet()
    trainer = trainers.BpeTrainer(
        vocab_size=VOCABULARY, special_tokens=marks, initial_alphabet=alphabet, show_progress=False
    )
    made.train_from_iterator(texts, trainer)
    found = Tokens(tokenizer_object=made, eos_token="<|im_end|>", pad_token="<|endoftext|>")
    found.chat_template = qwen3_chat_template
    return found


def model_of(words: Tokens) -> Qwen3ForCausalLM:
    """Return a model of three layers with drawn weights."""
    shape = {"hidden_size": 128, "intermediate_size": 384, "num_hidden_layers": 3, "num_attention_heads": 4}
    config = Qwen3Config(vocab_size=len(words), num_key_value_heads=4, head_dim=32, max_position_embeddings=8192,
                         tie_word_embeddings=True, eos_token_id=words.eos_token_id, pad_token_id=words.pad_token_id,
                         **shape)  # fmt: skip
    return Qwen3ForCausalLM(config)


def tools() -> list[dict]:
    """Return the tool of the environment as models see it."""
    return [get_json_schema(HearthEnv().act)]


def warmed(model: Qwen3ForCausalLM, words: Tokens, dialogues: list[list[dict]], steps: int) -> None:
    """Teach a model the form of a call: it learns the assistant's tokens of the dialogues."""
    examples = [labelled(words, messages) for messages in dialogues]
    made = torch.optim.AdamW(model.parameters(), 3e-3)
    for step in range(steps):
        loss = torch.stack([
            model(input_ids=numbers, labels=labels).loss
            for numbers, labels in (examples[(4 * step + n) % len(examples)] for n in range(4))
        ]).mean()  # fmt: skip
        loss.backward()
        made.step()
        made.zero_grad()


def labelled(words: Tokens, messages: list[dict]) -> tuple[torch.Tensor, torch.Tensor]:
    """Return a dialogue's tokens, and as labels those of the assistant."""
    text = words.apply_chat_template(messages, tools=tools(), tokenize=False)
    found = words(text, return_offsets_mapping=True)
    spans = [each.span(1) for each in ANSWERED.finditer(text)]
    labels = [
        number if any(first <= start and end <= last for first, last in spans) else -100
        for number, (start, end) in zip(found.input_ids, found.offset_mapping, strict=True)
    ]
    return torch.tensor([found.input_ids]), torch.tensor([labels])


def trainer_of(
    model: Qwen3ForCausalLM,
    words: Tokens,
    data: Dataset,
    folder: str,
    given: argparse.Namespace,
    longest: int = LONGEST,
) -> GRPOTrainer:
    """Return TRL's trainer with our environment; each step has three tasks; `longest` are tokens."""
    config = GRPOConfig(
        output_dir=folder, per_device_train_batch_size=3 * given.group, per_device_eval_batch_size=TASKS * ROLLOUTS,
        num_generations=given.group, num_generations_eval=ROLLOUTS, max_completion_length=longest,
        max_steps=given.steps, report_to=[], use_cpu=True, save_strategy="no", logging_steps=1, learning_rate=RATE,
        lr_scheduler_type="constant", max_tool_calling_iterations=TURNS, disable_tqdm=True, bf16=False, beta=0.0,
        seed=given.seed, temperature=1.0,
    )  # fmt: skip
    made = GRPOTrainer(
        model=model, args=config, train_dataset=data, eval_dataset=data, processing_class=words,
        environment_factory=Scored,
    )  # fmt: skip
    made.remove_callback(PrinterCallback)
    return made


def figure(trainer: GRPOTrainer) -> list[float]:
    """Return the mean reward of rollouts in all tasks, and the ends of its interval: tasks are drawn again."""
    Scored.rewards.clear()
    trainer.evaluate()
    means, chance = [fmean(each) for each in Scored.rewards.values()], Random(0)
    drawn = sorted(fmean(chance.choices(means, k=len(means))) for _ in range(2000))
    return [round(value, 3) for value in (fmean(means), drawn[50], drawn[-51])]


def main() -> None:
    """Train, and print a line of JSON with the rewards of the untrained model, before and after, and of each step."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, usual in (("steps", 10), ("group", 4), ("warm", 200), ("seed", 0)):
        options.add_argument(f"--{name}", type=int, default=usual)
    given = options.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.WARNING)
    set_seed(given.seed)
    began, chance, seeds = time.monotonic(), Random(given.seed), short_tasks()
    first = rows(1, **SOURCE)[0]
    dialogues = [dialogue(seed, first["prompt"][0]["content"], chance, RIGHTLY) for seed in seeds * DIALOGUES]
    words = tokenizer(dialogues)
    model = model_of(words)
    data = Dataset.from_list([{**first, "seed": seed} for seed in seeds])
    with tempfile.TemporaryDirectory() as folder:
        found: dict[str, Any] = {"untrained": figure(trainer_of(model, words, data, folder, given, SHORT))}
        warmed(model, words, dialogues, given.warm)
        trainer = trainer_of(model, words, data, folder, given)
        found["before"] = figure(trainer)
        trainer.train()
        found["after"] = figure(trainer)
        steps = [round(entry["reward"], 3) for entry in trainer.state.log_history if "reward" in entry]
    found |= {"tasks": TASKS, "rollouts": TASKS * ROLLOUTS, "steps": steps}
    found["weights"] = sum(weights.numel() for weights in model.parameters())
    found |= {"seconds": round(time.monotonic() - began), "of_processor": round(time.process_time())}
    print(json.dumps(found))


if __name__ == "__main__":
    main()
