"""Examples by words and vectors: a server's vectors, those of a small model on this disk, and the weight of each."""

from __future__ import annotations

import json
import os
from pathlib import Path

import numpy as np
import pytest
from lying_server import serving
from typer.testing import CliRunner

from hearth import cli
from hearth.llm.embeddings import EndpointVectors, vectors_of
from hearth.llm.endpoint import Endpoint
from hearth.llm.language_planner import LanguagePlanner
from hearth.llm.language_settings import Means
from hearth.models.interface import Request
from hearth.models.text.mixed_similarity import WEIGHTS, MixedSimilarity, chosen_weight
from hearth.models.text.retrieval import Similarity
from hearth.models.text.word_pieces import numbered
from hearth.models.text_examples import Example
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_steps

MEANINGS = {"milk": (1, 0), "dairy": (1, 0.1), "telly": (0, 1), "television": (0.1, 1)}
"""A server's opinion of words: those of a meaning have like vectors."""


def vector(text):
    found = [MEANINGS[word] for word in text.lower().replace(".", " ").split() if word in MEANINGS]
    return [float(sum(column)) + 0.01 for column in zip(*found, strict=True)] if found else [0.5, 0.5]


def embedding(body):
    assert set(body) == {"model", "input", "encoding_format"}
    data = [{"object": "embedding", "index": 0, "embedding": vector(body["input"])}]
    return {"object": "list", "data": data, "usage": {"prompt_tokens": 3, "total_tokens": 3}}


def example(title, line):
    return Example(title, title, title, f"{title} it.", tuple(parse_steps(line)))


TRAIN = (example("Use dairy", "[Drink] <milk> (1)"), example("Use telly", "[Watch] <television> (1)"))


def vectors(url, **means):
    return EndpointVectors(Endpoint(url, "mini", means=Means(tries=2, **means)))


def test_vectors_of_a_server_are_kept_and_counted(tmp_path):
    with serving(embedding) as (url, server):
        found = vectors(url, cache=tmp_path / "c")(["milk", "telly", "milk"])
        again = vectors(url, cache=tmp_path / "c", offline=True)(["telly", "milk"])
        ledger = Endpoint(url, "mini", means=Means(cache=tmp_path / "c")).spent
    assert found.shape == (3, 2) and np.allclose(np.linalg.norm(found, axis=1), 1)
    assert np.array_equal(again[::-1], found[:2]) and len(server.asked) == 2 and ledger.tokens_in == 6


@pytest.mark.parametrize(
    "given",
    [
        {"data": []},
        {"data": [{"embedding": []}]},
        {"data": [{"embedding": ["1", 2]}]},
        {"data": [{"embedding": [0, 0]}]},
        {"data": [{"embedding": [True, 1]}]},
        {"data": [{"embedding": [1e400, 1]}]},
        {"data": [{"embedding": [1]}, {"embedding": [2]}]},
        {"choices": [{"message": {"content": "hello"}}]},
        [1],
        b"nonsense",
        501,
    ],
)
def test_a_server_without_vectors_is_refused_and_nothing_is_kept(given, tmp_path):
    deed = given if isinstance(given, int | bytes) else json.dumps(given).encode()
    with serving(deed) as (url, _):
        with pytest.raises(HearthError, match="NO_ANSWER"):
            vectors(url, cache=tmp_path / "c")(["milk"])
        assert Endpoint(url, "mini", means=Means(cache=tmp_path / "c")).spent.replies == 0


def test_vectors_of_two_lengths_are_refused():
    def changing(body):
        return {"data": [{"embedding": [1.0] * (2 if body["input"] == "a" else 3)}]}

    with serving(changing) as (url, _), pytest.raises(HearthError, match="not of one length"):
        vectors(url)(["a", "b"])


def test_vectors_find_what_words_do_not():
    with serving(embedding) as (url, _):
        texts = ["Use the dairy", "See the telly"]
        mixed = MixedSimilarity(texts, vectors(url), 1.0)
        assert [places[0] for places, _ in mixed.nearest(["milk", "television"], 1)] == [0, 1]
    words = Similarity(texts).nearest(["milk", "television"], 1)
    assert [places[0] for places, _ in words] == [0, 0], "no word is shared"
    unweighted = MixedSimilarity(texts, lambda _: pytest.fail("asked"), 0.0).nearest(["the telly"], 2)
    assert unweighted == Similarity(texts).nearest(["the telly"], 2)


def test_validation_chooses_the_weight():
    asked = (example("Fetch milk", "[Drink] <milk> (1)"), example("Television", "[Watch] <television> (1)"))
    with serving(embedding) as (url, _):
        assert chosen_weight(TRAIN, asked, vectors(url)) > 0
    useless = chosen_weight(
        TRAIN, (example("Use telly", "[Watch] <television> (1)"),), lambda texts: np.eye(2)[[0] * len(texts)]
    )
    assert useless == 0.0 == min(WEIGHTS), "words alone are as good"


def test_a_planner_is_shown_what_vectors_find(knowledge):
    with serving(embedding) as (url, _), serving("[Grab] <milk> (1)") as (chat, server):
        model = LanguagePlanner(
            Endpoint(chat, "mini"), knowledge, TRAIN, 1, lambda texts: MixedSimilarity(texts, vectors(url), 1.0)
        )
        model.predict([Request("1", "Television", "See it.")])
    assert "telly" in server.asked[0]["messages"][1]["content"]


def test_options_that_do_not_fit_are_refused(tmp_path, made):
    for words, said in (
        (["llm:mini", "--embed", str(tmp_path)], "none are asked for"),
        (["nearest", "--embed", str(tmp_path)], "are about language models"),
        (["llm:mini", "--embed", str(tmp_path), "--shots", "2"], "no config.json"),
    ):
        out = ["--part", "train", "--out", str(tmp_path / "x.jsonl")]
        shown = CliRunner().invoke(cli.app, ["model", "predict", words[0], str(made.out), *words[1:], *out])
        assert shown.exit_code == 1 and said in shown.output.replace("\n", " "), shown.output


# A small model on this disk

PIECES = {"[PAD]": 0, "[UNK]": 1, "[CLS]": 2, "[SEP]": 3, "milk": 4, "##y": 5, "cafe": 6, ",": 7, "the": 8}


def test_pieces_of_words():
    assert numbered("The milky CAFÉ, milk", PIECES, 20) == [2, 8, 4, 5, 6, 7, 4, 3]
    assert numbered("zebra " + "m" * 300, PIECES, 20) == [2, 1, 1, 3]
    assert numbered("milk " * 50, PIECES, 6) == [2, 4, 4, 4, 4, 3] and numbered("", PIECES, 6) == [2, 3]


def weights(folder, **changed):
    """A BERT of one layer with drawn weights."""
    torch = pytest.importorskip("torch")
    from safetensors.torch import save_file

    size, inner = 8, 16
    drawn = torch.Generator().manual_seed(1)
    shapes = {
        "embeddings.word_embeddings.weight": (len(PIECES), size),
        "embeddings.position_embeddings.weight": (32, size),
        "embeddings.token_type_embeddings.weight": (2, size),
        **{f"{name}.LayerNorm.{part}": (size,) for part in ("weight", "bias")
           for name in ("embeddings", "encoder.layer.0.attention.output", "encoder.layer.0.output")},
        **{f"encoder.layer.0.attention.self.{name}.weight": (size, size) for name in ("query", "key", "value")},
        **{f"encoder.layer.0.attention.self.{name}.bias": (size,) for name in ("query", "key", "value")},
        "encoder.layer.0.attention.output.dense.weight": (size, size),
        "encoder.layer.0.attention.output.dense.bias": (size,),
        "encoder.layer.0.intermediate.dense.weight": (inner, size),
        "encoder.layer.0.intermediate.dense.bias": (inner,),
        "encoder.layer.0.output.dense.weight": (size, inner),
        "encoder.layer.0.output.dense.bias": (size,),
    }  # fmt: skip
    save_file(
        {name: torch.randn(shape, generator=drawn) for name, shape in shapes.items()}, folder / "model.safetensors"
    )
    config = {"model_type": "bert", "hidden_size": size, "num_hidden_layers": 1, "num_attention_heads": 2,
              "max_position_embeddings": 32, "layer_norm_eps": 1e-12, **changed}  # fmt: skip
    (folder / "config.json").write_text(json.dumps(config))
    (folder / "vocab.txt").write_text("\n".join(PIECES))
    return folder


def test_vectors_of_a_folder_do_not_depend_on_the_batch(tmp_path):
    model = vectors_of(str(weights(tmp_path)), Means())
    texts = ["milk", "the milky cafe, milk", "cafe"]
    found = model(texts)
    assert found.shape == (3, 8) and np.allclose(np.linalg.norm(found, axis=1), 1, atol=1e-5)
    for text, row in zip(texts, found, strict=True):
        assert np.allclose(model([text])[0], row, atol=1e-5)
    assert not np.allclose(found[0], found[2], atol=1e-3)


@pytest.mark.parametrize("spoil", ["kind", "weights", "layers", "json"])
def test_a_folder_of_something_else_is_refused(tmp_path, spoil):
    changed = {"kind": {"model_type": "llama"}, "layers": {"num_hidden_layers": 3}}.get(spoil, {})
    weights(tmp_path, **changed)
    if spoil == "weights":
        (tmp_path / "model.safetensors").write_bytes(b"nonsense")
    if spoil == "json":
        (tmp_path / "config.json").write_text("[]")
    with pytest.raises(HearthError, match="DAMAGED_FILE"):
        vectors_of(str(tmp_path), Means())


MINILM = os.environ.get("HEARTH_MINILM", "")


@pytest.mark.skipif(not MINILM, reason="HEARTH_MINILM names no folder of all-MiniLM-L6-v2")
def test_the_published_model_gives_the_published_similarities():
    """Those of its card."""
    one, *others = vectors_of(str(Path(MINILM)), Means())(
        ["That is a happy person", "That is a happy dog", "That is a very happy person", "Today is a sunny day"]
    )
    assert [round(float(one @ other), 3) for other in others] == [0.695, 0.943, 0.257]
