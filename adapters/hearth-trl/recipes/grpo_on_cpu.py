"""GRPO on a household task with a tiny model on the processor, by TRL and this package: figures before and after.

    python recipes/grpo_on_cpu.py [--steps 10] [--group 8] [--warm 200] [--seed 0]

Nothing is fetched: the tokenizer and the model are made here. The model first learns from dialogues to call the tool,
with a command that is right or drawn; GRPO then learns from the engine's rewards alone. The figures are mean rewards of
rollouts in starts that the training does not have. With a model of yours, leave out `warmed`.
"""

import argparse
import json
import logging
import re
import tempfile
import warnings
from random import Random

import torch
from hearth_trl import HearthEnv, rows
from tokenizers import Tokenizer, decoders, models, pre_tokenizers, trainers
from transformers import PreTrainedTokenizerFast, Qwen3Config, Qwen3ForCausalLM, set_seed
from transformers.utils import get_json_schema
from trl import GRPOConfig, GRPOTrainer
from trl.chat_template_utils import qwen3_chat_template

from datasets import Dataset

TASK = {"home": "maple", "goal": "HOLDS(agent, milk)", "limit": 60}

RIGHT = ("Walk kitchen", "Walk fridge", "Open fridge", "Grab milk 142")

OTHERS = ("Walk bedroom", "Walk kitchen", "wait", "Close fridge", "Grab milk 142")

RIGHTLY = 0.6
"""The share of right commands in the dialogues."""

TURNS = 6

TRAINED, ASKED = 100, 500
"""The first seeds of the starts that are trained on, and of those that the figures are of."""

ANSWERED = re.compile(r"<\|im_start\|>assistant\n(.*?<\|im_end\|>)", re.DOTALL)
"""The words of an assistant, with the mark of their end."""

Tokens = PreTrainedTokenizerFast


def dialogue(seed: int, chance: Random) -> list[dict]:
    """Return a dialogue in which each command is the next right one, or drawn."""
    env, done = HearthEnv(), 0
    prompt = rows(1, **TASK)[0]["prompt"][0]["content"]
    messages = [{"role": "user", "content": prompt + env.reset(seed, **TASK)}]
    for _ in range(TURNS):
        right = chance.random() < RIGHTLY
        command = RIGHT[min(done, len(RIGHT) - 1)] if right else chance.choice(OTHERS)
        done += right
        call = {"type": "function", "function": {"name": "act", "arguments": {"command": command}}}
        messages.append({"role": "assistant", "content": "", "tool_calls": [call]})
        messages.append({"role": "tool", "name": "act", "content": env.act(command)})
        if env.get_reward() == 1.0:
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
    trainer = trainers.BpeTrainer(vocab_size=3000, special_tokens=marks, initial_alphabet=alphabet, show_progress=False)
    made.train_from_iterator(texts, trainer)
    found = Tokens(tokenizer_object=made, eos_token="<|im_end|>", pad_token="<|endoftext|>")
    found.chat_template = qwen3_chat_template
    return found


def model_of(words: Tokens) -> Qwen3ForCausalLM:
    """Return a model of two layers with drawn weights."""
    shape = {"hidden_size": 64, "intermediate_size": 128, "num_hidden_layers": 2, "num_attention_heads": 4}
    config = Qwen3Config(vocab_size=len(words), num_key_value_heads=4, head_dim=16, max_position_embeddings=8192,
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


def trainer_of(model: Qwen3ForCausalLM, words: Tokens, steps: int, group: int, seed: int, folder: str) -> GRPOTrainer:
    """Return TRL's trainer with our environment."""
    config = GRPOConfig(
        output_dir=folder, per_device_train_batch_size=2 * group, per_device_eval_batch_size=4 * group,
        num_generations=group, num_generations_eval=group, max_completion_length=4096, max_steps=steps, report_to=[],
        use_cpu=True, save_strategy="no", logging_steps=1, learning_rate=2e-3, lr_scheduler_type="constant",
        max_tool_calling_iterations=TURNS, disable_tqdm=True, bf16=False, beta=0.0, seed=seed, temperature=1.0,
    )  # fmt: skip
    given = rows(20, **TASK)
    trained, asked = ([{**row, "seed": first + row["seed"]} for row in given] for first in (TRAINED, ASKED))
    return GRPOTrainer(
        model=model, args=config, train_dataset=Dataset.from_list(trained), eval_dataset=Dataset.from_list(asked[:8]),
        processing_class=words, environment_factory=HearthEnv,
    )  # fmt: skip


def main() -> None:
    """Train, and print a line of JSON with the mean rewards before and after, and of each step."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, usual in (("steps", 10), ("group", 8), ("warm", 200), ("seed", 0)):
        options.add_argument(f"--{name}", type=int, default=usual)
    given = options.parse_args()
    warnings.filterwarnings("ignore")
    logging.disable(logging.WARNING)
    set_seed(given.seed)
    chance = Random(given.seed)
    dialogues = [dialogue(TRAINED + n, chance) for n in range(60)]
    words = tokenizer(dialogues)
    model = model_of(words)
    warmed(model, words, dialogues, given.warm)
    with tempfile.TemporaryDirectory() as folder:
        trainer = trainer_of(model, words, given.steps, given.group, given.seed, folder)
        before = trainer.evaluate()["eval_reward"]
        trainer.train()
        after = trainer.evaluate()["eval_reward"]
        steps = [round(entry["reward"], 3) for entry in trainer.state.log_history if "reward" in entry]
    print(json.dumps({"before": round(before, 3), "after": round(after, 3), "rollouts": 8 * given.group,
                      "steps": steps}))  # fmt: skip


if __name__ == "__main__":
    main()
