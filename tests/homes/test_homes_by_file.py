"""A home may be given by the path of its file, in Python and on the command line."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

import hearth
from hearth.cli import app
from hearth.homes import library
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import to_release


@pytest.fixture
def scene(tmp_path, knowledge):
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(to_release(library.load_graph("maple", knowledge))))
    return path


def test_python_loads_a_graph_by_its_path(scene, knowledge):
    ours, mine = hearth.home("maple"), hearth.home(str(scene))
    assert mine.name == "mine" and mine.ids == ours.ids and mine.classes == ours.classes
    env = hearth.Env()
    env.reset(str(scene))
    assert env.world.home.name == "mine" and env.step("[Walk] <fridge> (1)").failures == {}
    assert library.named_graph("maple", knowledge)[0] == "maple"


def test_a_plan_is_a_home_too(tmp_path, knowledge):
    import shutil
    from importlib.resources import as_file, files

    with as_file(files("hearth.data_raw") / "homes") as folder:
        for path in folder.glob("maple.*"):
            shutil.copy(path, tmp_path / path.name.replace("maple", "mine"))
    assert library.named_graph(str(tmp_path / "mine.yaml"), knowledge)[0] == "mine"


@pytest.mark.parametrize("name", ["nowhere.json", "mapel", "", "../maple", "x.yaml"])
def test_what_is_no_file_is_refused_with_a_hint(name):
    with pytest.raises(HearthError) as refused:
        hearth.home(name)
    message = str(refused.value)
    assert "there is no home" in message and "--graph" not in message
    assert ("there is no file of that name" in message) == name.endswith((".json", ".yaml"))


def test_pictures_take_a_graph(tmp_path, scene):
    pytest.importorskip("cv2")
    file = tmp_path / "p.txt"
    file.write_text("Go\n\n\n[Walk] <fridge> (1)\n")
    for number, given in enumerate((("--graph", scene), ("--home", scene))):
        words = ["render-program", file, *given, "--out", tmp_path / str(number), "--width", 32, "--modalities", "rgb"]
        found = CliRunner().invoke(app, [*map(str, words), "--json"])
        assert found.exit_code == 0, found.output
        assert json.loads(found.stdout)["home"] == "mine"


def test_a_name_that_a_command_wants_is_not_a_file(tmp_path, scene, knowledge):
    with pytest.raises(HearthError, match="--homes FOLDER --home mine"):
        library.load_graph(str(scene), knowledge)
