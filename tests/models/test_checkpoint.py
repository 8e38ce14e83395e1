"""Checkpoints: a round trip, and everything that can be wrong with one."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys

import numpy as np
import pytest
import torch

from hearth.models.checkpoint import CARD, NAME, WEIGHTS, Checkpoint, load, save
from hearth.models.checkpoint_weights import filled
from hearth.models.model_registry import TRAINED, restore, restore_any
from hearth.models.text.step_vocabulary import StepVocabulary
from hearth.models.text.text_models import TextModel
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

WEIGHTS_OF = {"b": np.arange(6, dtype=np.float32).reshape(2, 3), "a": np.ones(2, dtype=np.float32).T}
MADE = Checkpoint("nearest", {"singular": 0}, {"words": ["tv"]}, WEIGHTS_OF, {"seed": 3, "epochs": 2})


@pytest.fixture
def folder(tmp_path):
    save(MADE, tmp_path / "made")
    return tmp_path / "made"


def code(folder):
    with pytest.raises(HearthError) as raised:
        restore(folder)
    (fault,) = raised.value.diagnostics
    assert fault.suggestion and fault.file
    return fault.code


def test_a_round_trip(folder):
    found = load(folder)
    assert (found.model, found.settings, found.content, found.trained) == (
        "nearest", {"singular": 0}, {"words": ["tv"]}, {"seed": 3, "epochs": 2},
    )  # fmt: skip
    assert {name: array.tolist() for name, array in found.weights.items()} == {
        name: array.tolist() for name, array in WEIGHTS_OF.items()
    }
    document = json.loads((folder / NAME).read_text())
    assert document["licence"] and document["action_set"] and document["libraries"]["torch"]
    assert "license:" in (folder / CARD).read_text() and "seed: 3" in (folder / CARD).read_text()


def test_the_same_checkpoint_is_the_same_bytes(folder, tmp_path):
    save(MADE, tmp_path / "again")
    for name in (NAME, WEIGHTS, CARD):
        assert (tmp_path / "again" / name).read_bytes() == (folder / name).read_bytes()


def test_no_checkpoint(tmp_path):
    assert code(tmp_path) == Code.MISSING_FILE
    with pytest.raises(HearthError, match="has not been trained"):
        restore("random-retrieval")


def test_another_format_and_an_unknown_model(folder):
    document = json.loads((folder / NAME).read_text())
    for changed in ({"format": 99}, {"model": "of-the-future"}):
        (folder / NAME).write_text(json.dumps(document | changed))
        assert code(folder) == Code.UNSUPPORTED_FILE


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 1}', '{"format": "one"}', "null"])
def test_broken_json(folder, text):
    (folder / NAME).write_text(text)
    assert code(folder) == Code.DAMAGED_FILE


def test_broken_weights(folder):
    whole = (folder / WEIGHTS).read_bytes()
    (folder / WEIGHTS).write_bytes(whole[:-1])
    assert code(folder) == Code.DAMAGED_FILE
    document = json.loads((folder / NAME).read_text())
    import hashlib

    broken = b"\xff" * 40
    (folder / WEIGHTS).write_bytes(broken)
    (folder / NAME).write_text(json.dumps(document | {"weights": hashlib.sha256(broken).hexdigest()}))
    assert code(folder) == Code.DAMAGED_FILE
    (folder / WEIGHTS).unlink()
    assert code(folder) == Code.MISSING_FILE


def test_changed_content_is_detected(folder):
    document = json.loads((folder / NAME).read_text())
    (folder / NAME).write_text(json.dumps(document | {"content": {"words": ["radio"]}}))
    assert code(folder) == Code.DAMAGED_FILE


def test_content_that_does_not_fit_the_model(folder):
    """It is what was written, but the model needs a memory."""
    assert code(folder) == Code.DAMAGED_FILE


def test_settings_larger_than_the_weights_cost_nothing(monkeypatch):
    """A network is compared with its weights before there is memory for it."""
    made = []

    def network(size):
        made.append(torch.empty(0).device.type)
        return torch.nn.Linear(size, size)

    weights = {name: value.numpy() for name, value in torch.nn.Linear(2, 2).state_dict().items()}
    assert not filled(lambda: network(2), weights).training
    with pytest.raises(ValueError, match="weight"):
        filled(lambda: network(1_000_000), weights)
    assert made == ["meta", "cpu", "meta"]


@pytest.mark.parametrize(
    ("name", "value"), [("layers", 10**9), ("hidden", "many"), ("hidden", True), ("dropout", float("nan")), ("odd", 1)]
)
def test_settings_that_no_model_has(name, value):
    """Settings of strangers are refused before anything is built with them."""
    with pytest.raises((TypeError, ValueError)):
        TextModel.of({name: value})


@pytest.mark.parametrize(
    ("name", "value"),
    [("arity", []), ("takes", [[[99]]]), ("classes", ["cup", "cup"]), ("spelt", {"mug": "bowl"}), ("words", [1])],
)
def test_a_vocabulary_whose_parts_do_not_fit(name, value):
    """A vocabulary that would fail when the model is asked fails when the checkpoint is read."""
    known = {"words": ["a"], "actions": ["Grab"], "arity": [1], "classes": ["cup"], "takes": [[[1]]], "spelt": {}}
    assert StepVocabulary.read(known).document()
    with pytest.raises(ValueError, match=f"{name} does not fit"):
        StepVocabulary.read({**known, name: value})


@pytest.mark.parametrize(
    ("name", "setting", "value", "said"),
    [
        ("goal-inference", "heads", 127, "`width` is 128, not a multiple of 127"),
        ("retrieve-edit", "neighbours", 0, "`neighbours` is 0, not 1 to"),
        ("mle-composed", "dropout", 2, "`dropout` is 2, not 0 to 1"),
    ],
)
def test_settings_of_a_stranger_that_make_no_model(tmp_path, name, setting, value, said):
    """That is a damaged checkpoint, not a fault of ours."""
    folder = shutil.copytree(TRAINED / name, tmp_path / "copy")
    document = json.loads((folder / NAME).read_text("utf-8"))
    document["settings"][setting] = value
    (folder / NAME).write_text(json.dumps(document), "utf-8")
    with pytest.raises(HearthError) as caught:
        restore_any(folder)
    assert caught.value.diagnostics[0].code == Code.DAMAGED_FILE and said in str(caught.value)


def rewritten(folder, change):
    document = json.loads((folder / NAME).read_text())
    change(document)
    (folder / NAME).write_text(json.dumps(document))
    return code(folder)


@pytest.mark.parametrize("facts", [
    {"minutes": "x"}, {"minutes": True}, {"seed": "0"}, {"seed": 1.5}, {"curves": []}, {"curves": {"score": 1}},
    {"curves": {"score": [None]}}, {"imitation": 7}, {"imitation": {"curves": {"score": ["x"]}}},
    {"return_imitated": {}},
])  # fmt: skip
def test_what_is_computed_with_of_a_training_is_numbers(folder, facts):
    assert rewritten(folder, lambda document: document["trained"].update(facts)) == Code.DAMAGED_FILE


def test_a_model_has_a_name_that_can_be_printed(folder):
    assert rewritten(folder, lambda document: document.update(model="\x1b[2J")) == Code.DAMAGED_FILE


def test_a_folder_with_the_description_is_whole(tmp_path, monkeypatch):
    from hearth.models import checkpoint

    def stopped(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(checkpoint, "write_json", stopped)
    with pytest.raises(KeyboardInterrupt):
        save(MADE, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted((CARD, WEIGHTS))
    (tmp_path / f".{WEIGHTS}.1234.tmp").write_bytes(b"half")
    monkeypatch.undo()
    save(MADE, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted((CARD, NAME, WEIGHTS))


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_weights_are_numbers(bad):
    weights = {"weight": np.full((1, 2), bad, np.float32), "bias": np.zeros(1, np.float32)}
    with pytest.raises(ValueError, match="weights weight are not all numbers"):
        filled(lambda: torch.nn.Linear(2, 1), weights)


@pytest.mark.parametrize(
    "row", [(-1, 1, 0), (10**9, 1, 0), (0, 0, 0), (1, 0, 0), (1, 1, 1), (1, 99_999, 0), (1, -1, 0)]
)
def test_a_strangers_closed_list_has_steps_of_its_vocabulary(row):
    vocabulary = StepVocabulary((), ("Walk", "Sleep"), (1, 0), ("sofa", "bed"), (((1, 2),), ()), {})
    assert vocabulary.read_closed([[1, 2, 0], [2, 0, 0]]) == ((1, 2, 0), (2, 0, 0))
    with pytest.raises(ValueError, match="closed list"):
        vocabulary.read_closed([row])


def test_a_draw_from_no_probabilities_is_refused():
    from hearth.models.text.step_heads import _drawn

    generator = torch.Generator().manual_seed(0)
    assert _drawn(torch.zeros(1, 1), generator).tolist() == [0]
    with pytest.raises(HearthError) as raised:
        _drawn(torch.tensor([[np.nan, 0.0]]), generator)
    assert raised.value.diagnostics[0].code == Code.DAMAGED_FILE


@pytest.mark.parametrize("bad", [["a", "a"], [[]], [1], [None]])
def test_names_are_different_texts(bad):
    from hearth.models.interface import texts

    assert texts(["a", "b"]) == ("a", "b")
    with pytest.raises(ValueError, match="list of names"):
        texts(bad)


@pytest.mark.parametrize("part", ["content", "settings", "trained"])
def test_values_too_deep_in_one_another(folder, part):
    text = (folder / NAME).read_text()
    document = json.loads(text)
    document[part]["deep"] = "DEEP"
    (folder / NAME).write_text(json.dumps(document).replace('"DEEP"', "[" * 300 + "]" * 300))
    assert code(folder) == Code.DAMAGED_FILE


def test_a_model_is_restored_without_the_compiler_of_pytorch():
    """Its import takes longer than everything else that reading with a model does."""
    asked = (
        "import sys; from hearth.models.model_registry import TRAINED, restore_any; "
        "restore_any(TRAINED / 'goal-inference'); print('torch._dynamo' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
