"""Writes a tiny language model with drawn weights for the server of transformers; run in that server's environment.

python tests/tiny_transformer.py FOLDER      # .venv/transformers/bin/python; nothing is fetched
"""

from __future__ import annotations

import sys

import torch
from tokenizers import Tokenizer, decoders, models, pre_tokenizers, trainers
from transformers import LlamaConfig, LlamaForCausalLM, PreTrainedTokenizerFast

TEMPLATE = (
    "{% for message in messages %}<|start|>{{ message['role'] }}\n{{ message['content'] }}<|end|>\n{% endfor %}"
    "{% if add_generation_prompt %}<|start|>assistant\n{% endif %}"
)

WORDS = "Walk Open Close Grab Put the fridge kitchen table milk cup bedroom and of a goal room wait [Walk] <fridge> (1)"
"""Text of which the tokens are made, besides single bytes."""

LONGEST = 8192
"""Tokens of a prompt and its reply."""


def tokens() -> PreTrainedTokenizerFast:
    """A tokenizer of bytes and a few words."""
    made = Tokenizer(models.BPE())
    made.pre_tokenizer, made.decoder = pre_tokenizers.ByteLevel(add_prefix_space=False), decoders.ByteLevel()
    alphabet, marks = pre_tokenizers.ByteLevel.alphabet(), ["<|start|>", "<|end|>"]
    made.train_from_iterator(
        [WORDS] * 9,
        trainers.BpeTrainer(vocab_size=400, special_tokens=marks, initial_alphabet=alphabet, show_progress=False),
    )
    found = PreTrainedTokenizerFast(tokenizer_object=made, eos_token="<|end|>", pad_token="<|end|>")
    found.chat_template = TEMPLATE
    return found


def main(folder: str) -> None:
    """Write the model and its tokenizer."""
    torch.manual_seed(0)
    words = tokens()
    config = LlamaConfig(
        vocab_size=len(words), hidden_size=64, intermediate_size=128, num_hidden_layers=2, num_attention_heads=4,
        max_position_embeddings=LONGEST, eos_token_id=words.eos_token_id, pad_token_id=words.pad_token_id,
    )  # fmt: skip
    LlamaForCausalLM(config).save_pretrained(folder)
    words.save_pretrained(folder)


if __name__ == "__main__":
    main(sys.argv[1])
