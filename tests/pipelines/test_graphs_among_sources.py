"""Graphs that come with sources: that of a program grounds it, that of a home is one to sample in."""

from __future__ import annotations

import json

import pytest
from builds import INPUT
from typer.testing import CliRunner

from hearth.cli import app

CABIN = json.loads((INPUT / "homes/cabin.json").read_text())
TELEVISION = 41
FINAL = {**CABIN, "nodes": [
    {**node, "states": ["ON", "PLUGGED_IN", "CLEAN"]} if node["id"] == TELEVISION else node for node in CABIN["nodes"]
]}  # fmt: skip


def program(*steps, **more):
    return {"title": "TV", "program": list(steps), "init_graph": CABIN} | more


PROGRAMS = {
    "ids": program(f"[Walk] <television> ({TELEVISION})", f"[SwitchOn] <tv> ({TELEVISION})"),
    "bound": program(f"[Walk] <television> (1.{TELEVISION})", f"[SwitchOn] <television> (1.{TELEVISION})"),
    "search": program("[Walk] <television> (1)", "[SwitchOn] <television> (1)"),
    "words": {**program(), "program": "1. Walk to the TV\n2. Turn on the TV"},
}


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_with_a_graph_is_grounded_in_it(write, built, name):
    build = built(write(f"{name}.json", json.dumps(PROGRAMS[name])), homes=())
    build.run("ingest", "validate", "sample")
    (case,) = build.rows("sample")
    assert (case["home"], case["executable"], build.rejects("sample")) == (name, True, [])
    (grounding,) = build.rows("validate")[0]["groundings"]
    assert [row["node"] for row in grounding["bindings"]] == [TELEVISION]


@pytest.mark.parametrize("node", [TELEVISION, 99])
def test_numbers_that_are_ids_of_nodes_are_meant(write, built, node):
    """A second television stands where the first does."""
    nodes = [*CABIN["nodes"], next({**one, "id": 99} for one in CABIN["nodes"] if one["id"] == TELEVISION)]
    twins = [{**edge, end: 99} for edge in CABIN["edges"] for end in ("from_id", "to_id") if edge[end] == TELEVISION]
    graph = {"nodes": nodes, "edges": [*CABIN["edges"], *twins]}
    build = built(write("two.json", json.dumps(program(f"[Walk] <tv> ({node})", init_graph=graph))))
    build.run("ingest", "validate")
    (grounding,) = build.rows("validate")[0]["groundings"]
    assert [row["node"] for row in grounding["bindings"]] == [node]


def test_a_list_of_grounded_programs_and_their_final_graphs(write, built):
    listed = [{**PROGRAMS["search"], "home": "hut", "final_graph": FINAL}, PROGRAMS["ids"]]
    build = built(write("many.json", json.dumps(listed)), homes=())
    build.run("ingest", "validate", "sample")
    assert [(row["home"], row["executable"]) for row in build.rows("sample")] == [("hut", True), ("many", True)]
    final = build.rows("ingest")[0]["groundings"][0]["final"]
    assert final["set_states"] == [{"node": TELEVISION, "state": "ON"}] and final["added"] == []


@pytest.mark.parametrize(
    ("changed", "stage", "code"),
    [
        ({"init_graph": {"nodes": [{"id": 1}], "edges": []}}, "ingest", "BAD_GRAPH"),
        ({"home": "../x"}, "ingest", "BAD_JSON"),
        ({"program": ["[Walk] <piano> (1)"]}, "validate", "UNBOUND"),
        ({"init_graph": {**CABIN, "edges": [*CABIN["edges"], CABIN["edges"][0]]}}, "", ""),
    ],
)
def test_a_faulty_graph_is_refused_alone(write, built, changed, stage, code):
    build = built(write("a.json", json.dumps({**PROGRAMS["search"], **changed})))
    build.run("ingest", "validate")
    assert len(build.rows("validate")) == 1
    found = [(name, row["code"], row["partial"]) for name in ("ingest", "validate") for row in build.rejects(name)]
    assert found == ([(stage, code, True)] if stage else [])


def test_a_scene_is_a_home_to_sample_in(write, built):
    write("in/hut_graph.json", json.dumps(CABIN))
    folder = write("in/a.txt", "TV\n\n[Walk] <television> (1)\n[SwitchOn] <television> (1)\n").parent
    build = built(folder, homes=("hut", "cabin"), variants=1).run_all()
    assert sorted(row["home"] for row in build.rows("sample")) == ["cabin", "hut"]
    assert all(row["executable"] for row in build.rows("sample"))
    assert (build.out / "ingest/homes/hut.json").exists()
    write("in/hut_graph.json", json.dumps({**CABIN, "nodes": CABIN["nodes"][:-1]}))
    assert build.run("ingest", "validate", "sample").fresh
    write("in/hut_graph.json", "[]")
    build.run("ingest")
    assert not (build.out / "ingest/homes").exists()


@pytest.mark.parametrize(("nodes", "lacks"), [(("Rooms",), "a room"), (("Characters",), "a character"), ((), "")])
def test_a_scene_in_which_nothing_can_run_is_refused(write, built, nodes, lacks):
    kept = {node["id"]: node for node in CABIN["nodes"] if node["category"] not in nodes}
    edges = [edge for edge in CABIN["edges"] if {edge["from_id"], edge["to_id"]} <= kept.keys()]
    folder = write("in/hut.json", json.dumps({"nodes": list(kept.values()), "edges": edges})).parent
    write("in/a.txt", "TV\n\n[Walk] <television> (1)\n")
    build = built(folder)
    build.run("ingest")
    messages = [(row["code"], row["message"]) for row in build.rejects("ingest")]
    assert messages == ([("BAD_GRAPH", f"no home to sample programs in: it lacks {lacks}")] if lacks else [])


def test_a_scene_without_programs_says_so(write, tmp_path):
    arguments = ["build", str(write("hut.json", json.dumps(CABIN))), "--out", str(tmp_path / "out"), "-j", "1"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 1 and "not one program in the sources" in result.output


def test_run_uses_the_graph_of_a_program(write):
    file = str(write("hut.json", json.dumps(PROGRAMS["ids"])))
    found = json.loads(CliRunner().invoke(app, ["run", file, "--json"]).stdout)
    assert (found["home"], found["executable"], found["added_nodes"]) == ("hut", True, [])
    assert list(found["binding"].values()) == [TELEVISION]
    found = json.loads(CliRunner().invoke(app, ["run", str(write("a.txt", "T\n\n[Sleep]\n")), "--json"]).stdout)
    assert found["home"] == "maple"
    assert json.loads(CliRunner().invoke(app, ["run", file, "--home", "maple", "--json"]).stdout)["home"] == "maple"


def test_scenes_of_the_release(real_data, built):
    build = built(real_data / "homes", homes=())
    build.run("ingest")
    names = sorted(path.stem for path in (build.out / "ingest/homes").glob("*.json"))
    assert names == [f"TrimmedTestScene{number}" for number in range(1, 8)]
