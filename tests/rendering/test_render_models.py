"""Models are read from data: what they draw is held by a golden file, and what is wrong in them is named."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
import yaml

from hearth.rendering.models import model_recipes, object_pictures
from hearth.rendering.models.appearance import Look
from hearth.rendering.models.class_appearance import Model, draw
from hearth.rendering.models.mesh import join
from hearth.rendering.models.model_expressions import MATH, Scope, text_of
from hearth.rendering.models.model_interpreter import Interpreter
from hearth.rendering.models.model_recipes import ENTRY, FAMILIES, RECIPES
from hearth.rendering.models.primitives import KNOWN, names_of
from hearth.schemas.diagnostics import HearthError

GOLDEN = Path(__file__).parents[1] / "golden" / "models.json"
REFRESH = "if the models are right: HEARTH_REFRESH=1 python -m pytest tests/rendering/test_render_models.py"
STATES = frozenset(), frozenset(("OPEN",)), frozenset(("ON",)), frozenset(("CLOSED",))


def figures(name):
    """Numbers that change when any triangle, its place in the order, its paint or a place on it does."""
    recipe = RECIPES[name]
    looks = [
        Look(tuple(s * k for s, k in zip(recipe.size, scale, strict=True)), variant, seed, states, kind=kind)
        for kind in recipe.kinds or ("",)
        for variant in range(recipe.variants)
        for seed, (states, scale) in enumerate(
            zip(STATES, ((1, 1, 1), (1, 1, 1), (1.4, 0.7, 1), (0.6, 1.3, 2)), strict=True)
        )
    ]
    mesh = join(draw(Model(name, look)) for look in looks)
    regions = [
        (*region, where) for look in looks for where, at in enumerate((recipe.on, recipe.inside)) for region in at(look)
    ]
    found = [len(mesh)]
    for array in (mesh.corners, mesh.normals, mesh.uvs, mesh.surface, mesh.textures, np.array(regions or [0.0])):
        values = np.asarray(array, np.float64).reshape(-1)
        found += [values.sum(), values @ np.sin(np.arange(len(values)))]
    return [round(float(value), 3) for value in found]


def test_models_look_as_they_did():
    drawn = {name: figures(name) for name in RECIPES}
    if os.environ.get("HEARTH_REFRESH"):
        GOLDEN.write_text("{\n" + ",\n".join(f"{json.dumps(n)}: {json.dumps(v)}" for n, v in drawn.items()) + "\n}\n")
    golden = json.loads(GOLDEN.read_text())
    assert list(drawn) == list(golden), REFRESH
    wrong = [name for name, values in drawn.items() if not np.allclose(values, golden[name], rtol=1e-4, atol=0.02)]
    assert wrong == [], REFRESH


def test_every_entry_has_a_name_of_its_own_and_is_compiled():
    found = [
        entry
        for family in FAMILIES
        for entry in ENTRY.findall(text_of(model_recipes.PACKAGE, family))
        if entry[0] != "shared"
    ]
    assert sorted(name for name, _ in found) == sorted({name for name, _ in found})
    assert [name for name, takes in found if not takes] == list(RECIPES)
    assert all(model_recipes._drawn(name) for name, _ in found)


def test_no_key_is_written_twice():
    def keys(node):
        if isinstance(node, yaml.MappingNode):
            names = [key.value for key, _ in node.value]
            assert len(names) == len(set(names)), (node.start_mark.line + 1, names)
        for part in node.value if not isinstance(node, yaml.ScalarNode) else ():
            for each in part if isinstance(part, tuple) else (part,):
                keys(each)

    for family in FAMILIES:
        keys(yaml.compose(text_of(model_recipes.PACKAGE, family), yaml.BaseLoader))
    keys(yaml.compose(text_of(object_pictures.PACKAGE, object_pictures.FILE), yaml.BaseLoader))


def test_a_model_that_does_not_exist_is_a_missing_key():
    assert "no_such_model" not in RECIPES and "legs" not in RECIPES and "chair" in RECIPES
    with pytest.raises(KeyError):
        RECIPES["no_such_model"]


def drawn(entry, find=lambda name: None):
    scope = model_recipes._scope("seats.yaml", "stool", KNOWN)
    return Interpreter(find).definition(entry, "", {}, scope)(names_of(Look((1.0, 1.0, 1.0))), (), {})


BOX = {"box": [["0", "h / 2", "0"], ["w", "h", "d"]], "paint": "OAK"}


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ({"box": [["0", "hh", "0"]], "paint": "OAK"}, "stool: box: unknown name `hh` in"),
        ({**BOX, "paint": "OKA"}, "did you mean `OAK`?"),
        ({**BOX, "paint": "OAK.color"}, "Attribute is not allowed in"),
        ({**BOX, "paint": "(lambda: OAK)()"}, "is not allowed in"),
        ({**BOX, "paint": "__import__('os')"}, "unknown name `__import__`"),
        ({**BOX, "paint": "OAK +"}, "is not an expression"),
        ({**BOX, "when": "w"}, "stool: box: box() got an unexpected keyword argument 'when'"),
        ({"when": "1 / (w - 1)", **BOX}, "stool: when: float division by zero in `1 / (w - 1)`"),
        ({"for": "3", **BOX}, "`3` is not a repetition (write `for: k in range(3)`)"),
        ({**BOX, "turn": ["a", "90"]}, "stool: turn: `a` is not an axis (x, y, z)"),
        ({"boxes": []}, "stool: boxes: is not a shape"),
        ({"parts": [BOX], "paint": "OAK"}, "stool: parts: has no options (paint)"),
        ({"let": {"x": "1"}}, "stool: an entry has no shape"),
    ],
)
def test_a_fault_names_file_model_and_expression(entry, message):
    with pytest.raises(HearthError, match=re.escape(message)) as caught:
        drawn(entry)
    assert caught.value.diagnostics[0].file == "rendering/models/seats.yaml"


def test_a_shape_gets_what_it_takes():
    leg = Interpreter(lambda name: None).definition(
        BOX, "w, h, d=0.5", {}, model_recipes._scope("seats.yaml", "leg", KNOWN)
    )
    low, high = drawn({"leg": ["2", "3"]}, {"leg": leg}.get).bounds()
    assert np.allclose(high - low, (2, 3, 0.5))
    with pytest.raises(HearthError, match=re.escape("leg: takes (w, h, d); given 1 and ()")):
        drawn({"leg": ["2"]}, {"leg": leg}.get)


def test_an_entry_is_read_from_top_to_bottom():
    entry = {"for": "k in range(3) for s in (-1, 1)", "let": {"x": "k * s"}, "when": "x != 0", **BOX, "shift": ["x"]}
    assert len(drawn(entry)) == 4 * len(drawn(BOX))
    chosen = {"either": [{"when": "w > 2", **BOX}, {"parts": [BOX, BOX]}, BOX]}
    assert len(drawn(chosen)) == 2 * len(drawn(BOX))


def test_a_picture_is_its_strokes_in_order():
    scope = Scope("rendering/models/pictures.yaml", "flag", frozenset(MATH))
    flag = np.zeros((object_pictures.SIDE, object_pictures.SIDE, 3), np.uint8)
    halves = {"for": "k in range(3)", "when": "k", "fill": ["0", "0", "1", "0.25 * k", ["k", "0", "9"]]}
    object_pictures._paint(
        [{"ground": ["5", "6", "7"]}, {"for": "n in (1, 1)", "all": [halves]}], flag, dict(MATH), scope
    )
    assert flag[0, 0].tolist() == flag[127, 9].tolist() == [2, 0, 9]
    assert flag[128, 9].tolist() == [5, 6, 7]
    with pytest.raises(HearthError, match="flag: `fil` is not a stroke"):
        object_pictures._paint([{"fil": []}], flag, dict(MATH), scope)
