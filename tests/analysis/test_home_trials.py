"""Scene graphs tried out: names, boxes, furniture in furniture, programs that run; task files of plain values."""

from __future__ import annotations

import json
import pickle

import pytest
from typer.testing import CliRunner

from hearth.analysis.home_trials import drawn, tried
from hearth.cli import app
from hearth.commands.inputs import paths
from hearth.homes.library import load_graph
from hearth.interop.virtualhome.task_graphs import task_graphs
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import to_release
from hearth.schemas.syntax import parse_programs

MILK = parse_programs("Milk\n\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n").programs
ROCKET = parse_programs("Fly\n\n\n\n[Walk] <rocket> (1)\n").programs


@pytest.fixture(scope="module")
def maple(knowledge):
    return load_graph("maple", knowledge)


def test_boxes_of_a_file_are_used_and_its_programs_run(maple, knowledge):
    found = tried(maple, "maple", [*ROCKET, *MILK], 10, knowledge)
    boxes = sum(node.box is not None for node in maple.nodes)
    assert (found.bound, found.nodes, found.used, found.laid_out) == (367, 367, boxes, 0)
    assert (found.programs, found.ran, found.in_each_other) == (1, 1, [])


def test_furniture_in_furniture_and_strange_names_are_named(maple, knowledge):
    data = json.loads(json.dumps(to_release(maple)))
    couch, table = (next(n for n in data["nodes"] if n["class_name"] == name) for name in ("couch", "coffee_table"))
    table["bounding_box"]["center"] = couch["bounding_box"]["center"]
    data["nodes"].append({"id": 9000, "class_name": "flurbo", "category": "Props", "properties": [], "states": []})
    from hearth.schemas.graph import from_release

    found = tried(from_release(data), "odd", MILK, 1, knowledge)
    assert found.unknown == {"flurbo": 1}
    assert any("coffee_table" in words and "couch" in words for words in found.in_each_other)


@pytest.mark.parametrize("written", [lambda rows: json.dumps(rows).encode(), pickle.dumps], ids=["json", "pickle"])
def test_each_home_of_a_file_of_tasks_is_read_once(maple, knowledge, tmp_path, written):
    graph = json.loads(json.dumps(to_release(maple)))
    rows = [{"task_id": k, "env_id": k % 2, "init_graph": graph} for k in range(4)]
    path = tmp_path / ("tasks.json" if written is not pickle.dumps else "tasks.pik")
    path.write_bytes(written(rows))
    assert [name for name, _ in task_graphs(path, knowledge)] == ["tasks[0]", "tasks[1]"]


class Attack:
    def __reduce__(self):
        return print, ("code ran",)


def test_a_pickle_with_code_is_refused(knowledge, tmp_path, capsys):
    path = tmp_path / "tasks.pik"
    for data in (pickle.dumps([Attack()]), b"\x80\x04", b"no pickle", pickle.dumps({"a": 1})):
        path.write_bytes(data)
        with pytest.raises(HearthError):
            list(task_graphs(path, knowledge))
    assert "code ran" not in capsys.readouterr().out


def test_the_command(maple, tmp_path):
    path = tmp_path / "maple.json"
    path.write_text(json.dumps(json.loads(json.dumps(to_release(maple)))))
    result = CliRunner().invoke(app, ["home", "try", str(path), "--programs", "2", "--json"])
    (found,) = json.loads(result.output)
    assert result.exit_code == 0 and found["ran"] == found["programs"] == 2


@pytest.mark.slow
def test_the_seven_homes_of_the_release(real_data, knowledge):
    programs = drawn(paths([]), knowledge, 0)
    for number in range(1, 8):
        for name, graph in task_graphs(real_data / f"homes/TrimmedTestScene{number}_graph.json", knowledge):
            found = tried(graph, name, programs, 10, knowledge)
            assert found.bound == found.nodes and not found.in_each_other
            assert found.programs == 10 and found.ran >= 9
