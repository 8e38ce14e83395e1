"""Vectors of texts by a small BERT model in a folder on this disk, such as all-MiniLM-L6-v2; nothing is fetched."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hearth.models.text.word_pieces import numbered, pieces_of
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.optional_libraries import library

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

FILES = ("config.json", "vocab.txt", "model.safetensors")
"""The files of a model."""

MOST_PIECES = 256
"""Pieces of a text that are read."""

AT_ONCE = 64
"""Texts at a time."""

FAULTS = (ValueError, KeyError, TypeError, RuntimeError, OSError)
"""The errors of reading files that are something else."""

_KIND = "bert"


class SentenceVectors:
    """The model of a folder: vectors of length 1, the mean over the pieces of a text.

    Args:
        folder: with `FILES`, as Hugging Face has them.

    Raises:
        HearthError: MISSING_FILE: a file, or the extra `models`, is lacking; DAMAGED_FILE: it is another kind of model,
            or not whole.
    """

    def __init__(self, folder: Path) -> None:
        self._torch, tensors = library("torch"), library("safetensors")
        missing = [name for name in FILES if not (folder / name).is_file()]
        if missing:
            message = f"the folder has no {' and no '.join(missing)}"
            remedy = "a folder of a BERT model as Hugging Face has it, such as all-MiniLM-L6-v2"
            raise HearthError.of(Code.MISSING_FILE, message, file=str(folder), suggestion=remedy)
        try:
            self._config = json.loads((folder / FILES[0]).read_text(encoding="utf-8"))
            if self._config["model_type"] != _KIND:
                raise ValueError(f"the model is of the kind {str(self._config['model_type'])[:40]}, not {_KIND}")
            self._pieces = pieces_of(folder / FILES[1])
            self._weights = library("safetensors.torch").load_file(str(folder / FILES[2]))
            self._run([self._numbers("a")])
        except (*FAULTS, tensors.SafetensorError) as error:
            message = f"these are not the weights of a BERT model: {str(error)[:100]}"
            raise HearthError.of(Code.DAMAGED_FILE, message, file=str(folder)) from error

    def __call__(self, texts: Sequence[str]) -> NDArray[np.float32]:
        """Return a vector for each text."""
        import numpy as np

        order = sorted(range(len(texts)), key=lambda place: len(texts[place]))  # of a like length together
        found = np.zeros((len(texts), int(self._config["hidden_size"])), np.float32)
        for first in range(0, len(order), AT_ONCE):
            some = order[first : first + AT_ONCE]
            found[some] = self._run([self._numbers(texts[place]) for place in some])
        return found

    def _numbers(self, text: str) -> list[int]:
        most = min(MOST_PIECES, int(self._config["max_position_embeddings"]))
        return numbered(text, self._pieces, most)

    def _run(self, rows: Sequence[Sequence[int]]) -> Any:
        torch = self._torch
        longest = max(map(len, rows))
        numbers = torch.tensor([[*row, *[0] * (longest - len(row))] for row in rows])
        there = torch.tensor([[1.0] * len(row) + [0.0] * (longest - len(row)) for row in rows])
        with torch.inference_mode():
            hidden = self._begun(numbers)
            for number in range(int(self._config["num_hidden_layers"])):
                hidden = self._layer(f"encoder.layer.{number}", hidden, there)
            mean = (hidden * there[:, :, None]).sum(1) / there.sum(1, keepdim=True)
            return torch.nn.functional.normalize(mean).numpy()

    def _begun(self, numbers: Any) -> Any:
        words, places, kinds = (
            self._weights[f"embeddings.{name}_embeddings.weight"] for name in ("word", "position", "token_type")
        )
        return self._evened("embeddings", words[numbers] + places[: numbers.shape[1]] + kinds[0])

    def _layer(self, name: str, hidden: Any, there: Any) -> Any:
        torch, heads = self._torch, int(self._config["num_attention_heads"])
        batch, length, size = hidden.shape
        query, key, value = (
            self._linear(f"{name}.attention.self.{part}", hidden).view(batch, length, heads, -1).transpose(1, 2)
            for part in ("query", "key", "value")
        )
        mask = (there[:, None, None, :] - 1) * 1e9
        mixed = torch.nn.functional.scaled_dot_product_attention(query, key, value, attn_mask=mask)
        mixed = self._linear(f"{name}.attention.output.dense", mixed.transpose(1, 2).reshape(batch, length, size))
        hidden = self._evened(f"{name}.attention.output", hidden + mixed)
        inner = torch.nn.functional.gelu(self._linear(f"{name}.intermediate.dense", hidden))
        return self._evened(f"{name}.output", hidden + self._linear(f"{name}.output.dense", inner))

    def _linear(self, name: str, value: Any) -> Any:
        return self._torch.nn.functional.linear(value, self._weights[f"{name}.weight"], self._weights[f"{name}.bias"])

    def _evened(self, name: str, value: Any) -> Any:
        scale, shift = (self._weights[f"{name}.LayerNorm.{part}"] for part in ("weight", "bias"))
        return self._torch.nn.functional.layer_norm(
            value, scale.shape, scale, shift, float(self._config["layer_norm_eps"])
        )
