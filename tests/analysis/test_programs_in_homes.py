"""Coverage: every pair of a program and a home is counted."""

import orjson
import pytest
from typer.testing import CliRunner

from hearth.analysis.programs_in_homes import measure_coverage, scripts
from hearth.cli import app
from hearth.grounding.environments.sampling import Size
from hearth.pipelines.engine.build_homes import Homes
from hearth.pipelines.engine.settings import Settings
from hearth.schemas.failures import Code

PROGRAMS = {
    "tea": "Tea\nA cup.\n\n\n[Walk] <kitchen> (1)\n[Walk] <cup> (1)\n[Grab] <cup> (1)\n",
    "late": "Television\nWithout power.\n\n\n[Walk] <television> (1)\n[TurnTo] <television> (1)\n"
    "[PlugOut] <television> (1)\n[SwitchOn] <television> (1)\n",
    "flying": "Flying\nUp.\n\n\n[Fly] <cup> (1)\n",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    place = tmp_path_factory.mktemp("programs")
    for name, text in PROGRAMS.items():
        (place / f"{name}.txt").write_text(text)
    return place


@pytest.fixture(scope="module")
def homes():
    return Homes(Settings(homes=("maple", "cedar")))


def test_every_pair_ran_or_is_proven_impossible(folder, homes):
    found = measure_coverage(scripts([str(folder)], homes.knowledge), homes, homes.names())
    assert (found.programs, found.rejected, found.pairs, found.ran) == (2, 1, 4, 2)
    ((script, where, failure),) = found.impossible
    assert failure.code is Code.CONTRADICTION and where == "any home" and script.place.endswith("late.txt")
    assert found.failed == []
    summary = found.summary()
    assert summary["pairs"] == summary["ran"] + summary["proven_impossible"] + summary["failed"]
    assert 100 < summary["bytes_an_environment"] < 20_000


def test_the_size_asked_for_is_kept(folder, homes):
    found = measure_coverage(scripts([str(folder)], homes.knowledge), homes, ("maple",), size=Size(470, 480))
    assert found.nodes and all(460 <= count <= 480 for count in found.nodes)


def test_the_command_names_the_two_steps(folder):
    done = CliRunner().invoke(app, ["sample", str(folder), "--home", "maple", "--homes", "all", "--json"])
    assert done.exit_code == 0
    result = orjson.loads(done.stdout)
    assert result["ran"] == 1 and result["failures_by_code"] == {"CONTRADICTION": 1}
    (one,) = result["impossible"]
    assert [step["step"] for step in one["steps"]] == [3, 4]
    assert [step["line"] for step in one["steps"]] == [7, 8]


@pytest.mark.parametrize("option", ["--nodes", "--limit"])
def test_options_of_coverage_are_refused_without_it(tmp_path, option):
    done = CliRunner().invoke(app, ["sample", "--out", str(tmp_path), option, "100"])
    assert done.exit_code == 2 and option in done.stderr and "SOURCE" in done.stderr


def test_the_releases_graphs_are_not_read(real_data, homes):
    """Reading them all would take minutes."""
    found = scripts([str(real_data / "activityprograms-sample.zip")], homes.knowledge)
    program = next(found).program
    assert program.steps and not any(ref.node for ref in program.objects())


def test_what_a_home_cannot_hold_is_proven_for_that_home_alone(tmp_path):
    (tmp_path / "homes").mkdir()
    nodes = [(1, "bedroom", "Rooms"), (2, "character", "Characters"), (3, "bed", "Furniture")]
    edges = [{"from_id": i, "relation_type": "INSIDE", "to_id": 1} for i in (2, 3)]
    graph = {"nodes": [{"id": i, "class_name": n, "category": c} for i, n, c in nodes], "edges": edges}
    (tmp_path / "homes" / "cell.json").write_bytes(orjson.dumps(graph))
    (tmp_path / "bath.txt").write_text("Bath\nIn it.\n\n\n[Walk] <bathroom> (1)\n")
    homes = Homes(Settings(homes=("maple", "cell"), homes_folder=str(tmp_path / "homes")))
    found = measure_coverage(scripts([str(tmp_path / "bath.txt")], homes.knowledge), homes, homes.names())
    assert [(where, failure.code) for _, where, failure in found.impossible] == [("cell", Code.NO_ROOM)]
    assert (found.ran, found.summary()["proven_impossible"]) == (1, 1)
