"""Tables of chapter 5: rows beside the thesis's, what is tested, and sketches that models of texts write."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.analysis.augmentation_results import figures
from hearth.datasets.graph_sizes import graph_sizes
from hearth.models.fit_model import fit
from hearth.models.sketches.dataset_size_table import dataset_table
from hearth.models.sketches.sketch_result_tables import COLUMNS, _other_person, table
from hearth.models.text_examples import requests
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program
from hearth.scoring.baselines import Example

HOW = {"epochs": 1, "minutes": 0.0, "rate": 1e-3, "seed": 0}


SPLIT = "activities"


@pytest.fixture(scope="module")
def models(parted, tmp_path_factory):
    """Models that have hardly learned anything."""
    folder = tmp_path_factory.mktemp("models")
    for name, settings in (
        ("resactgraph", ("programs=8", "hidden=16")),
        ("retrieve-sketch", ()),
        ("unaries", ("programs=8", "hidden=16")),
    ):
        fit(name, parted.folder, folder / name, SPLIT, settings, how=HOW)
    return folder


def test_5_2(parted, models):
    rows = table("5.2", parted, SPLIT, [models / "resactgraph", models / "resactgraph", "planner"], most=6)
    by_name = {row.method: row for row in rows}
    assert by_name["ResActGraph"].scores["lcs_instances"] == 0.516 and by_name["ResActGraph"].of == "thesis"
    ours = by_name["resactgraph (K=2)"]
    assert ours.seeds == 2 and ours.minutes is not None
    assert ours.scores["executable"].mean == ours.scores["parsable"].mean == 1
    assert by_name["planner"].scores["executable"].mean == 1
    assert by_name["empty program"].scores["f1"].mean < by_name["planner"].scores["f1"].mean
    assert {"random legal steps", "sketch alone", "nearest sketch", "resactgraph (K=2), free"} <= set(by_name)
    assert set(ours.scores) <= set(COLUMNS)


def test_5_3_has_models_by_rounds(parted, models):
    rows = table("5.3", parted, SPLIT, [models / "resactgraph", models / "unaries"], most=4)
    names = [row.method for row in rows if row.of != "thesis"]
    assert names == ["planner", "resactgraph (K=2)", "resactgraph (K=2), free", "unaries (K=0)", "unaries (K=0), free"]


def test_5_4_runs_after_a_model_of_texts(parted, models):
    rows = table("5.4", parted, SPLIT, [models / "retrieve-sketch", models / "resactgraph"], most=4)
    by_name = {row.method: row for row in rows}
    written = by_name["retrieve-sketch, planner"]
    assert 0 <= written.scores["sketch"].mean <= 1 and written.scores["executable"].mean == 1
    assert "sketch" not in by_name["planner, given sketches"].scores
    assert by_name["Another person, same text"].of == "yardstick"
    with pytest.raises(HearthError, match="writes sketches"):
        table("5.4", parted, SPLIT, ["planner"], most=4)


def test_the_sketches_of_two_people_are_compared():
    """Each with the first other one of the same text; a text of its own has none."""
    sketches = ("[Sit] <sofa> (1)", "[Sit] <sofa> (1)", "[Sit] <sofa> (1)\n[Read] <book> (1)")
    programs = [parse_program(f"Title\n\n\n{lines}")[0].steps for lines in sketches]
    every = [Example(str(n), "Sit down", steps, steps) for n, steps in enumerate(programs)]
    alone = Example("3", "Read", programs[0], programs[0])
    row = _other_person([*every, alone], [*every, alone], ["a", "a", "a", "b"], 0)
    assert row.scores["sketch"].mean == pytest.approx((1 + 1 + 0.5) / 3)


def test_5_1_counts_programs(parted):
    rows = {row.programs: row for row in dataset_table(parted)}
    ((programs,),) = parted.rows("SELECT count(*) FROM programs WHERE parent_id IS NULL")[1]
    assert rows["Original"].number == programs and rows["VirtualHome"].number == 2807
    assert rows["Executable"].nodes > 100 and rows["Executable"].edges > rows["Executable"].nodes
    same = figures(parted.folder)["table"]
    for row, kind in (("Executable", "executable"), ("Augmented", "augmented"), ("All executable", "all")):
        ours = same[kind]["ours"]
        assert [ours["programs"], *list(ours.values())[1:]] == [*rows[row][2:]]


def test_sizes_of_graphs_are_those_of_the_worlds(parted):
    names = [name for (name,) in parted.rows("SELECT execution_id FROM executions WHERE executable ORDER BY 1")[1]]
    graphs = [each.world.graph() for share in requests(parted, names, worlds=True) for each in share if each.world]
    found = graph_sizes(parted, "all")
    assert found.nodes == round(sum(len(graph.nodes) for graph in graphs) / len(names), 2)
    assert found.edges == round(sum(len(graph.edges) for graph in graphs) / len(names), 2)


def test_the_command(parted, models):
    words = ["model", "table", "5.2", str(parted.folder), "--model", "planner", "--most", "2", "--json"]
    result = CliRunner().invoke(cli.app, words)
    assert result.exit_code == 0, result.output
    assert {row["of"] for row in json.loads(result.stdout)} == {"thesis", "yardstick"}
    assert CliRunner().invoke(cli.app, ["model", "table", "5.1", str(parted.folder)]).exit_code == 0
    result = CliRunner().invoke(cli.app, ["model", "table", "5.9", str(parted.folder)])
    assert result.exit_code == 1 and "there are 5.2" in result.output


def test_kinds_of_sketches(parted):
    with pytest.raises(HearthError, match="annotated, inferred"):
        table("5.2", parted, SPLIT, ["planner"], most=2, sketches="drawn")
