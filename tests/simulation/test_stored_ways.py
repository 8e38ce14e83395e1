"""Stored distance fields: those that are computed, read without a doubt, and worth nothing where they are not true."""

import math

import numpy as np
import pyarrow as pa
import pytest

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.simulation.motion import stored_distance_fields
from hearth.simulation.motion.distance_field_jobs import Wanted, make
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.navigation import Ways
from hearth.simulation.world.home import Home

FEW = 5


@pytest.fixture(scope="module")
def ground(maple):
    return ground_of(maple).ground


def stored(ground, folder):
    """The ways of the floor anew, which read what a folder holds."""
    ways = Ways(ground.floor)
    ways.stored = stored_distance_fields.StoredWays(ways, folder).field
    ways._field = None  # nothing can be computed
    return ways


def test_what_is_read_is_what_is_computed(ground, tmp_path):
    every = ground.every()[:FEW]
    stored_distance_fields.store(ground.ways, every, tmp_path)
    ways = stored(ground, tmp_path)
    for ends in every:
        made, read = Ways(ground.floor).field(ends), ways.field(ends)
        assert (list(read.distance), list(read.following)) == (list(made.distance), list(made.following))
        assert ways.stepped(read, 3.0, 3.0, 1.0) == ways.stepped(made, 3.0, 3.0, 1.0)
    with pytest.raises(TypeError):
        ways.field(ground.every()[FEW])


def shorter(distance, following, cell, far):
    distance[cell] -= 0.05


def through_a_wall(distance, following, cell, far):
    following[cell] = far


def beyond(distance, following, cell, far):
    following[cell] = len(distance)


def in_a_circle(distance, following, cell, far):
    following[cell] = cell


def early(distance, following, cell, far):
    following[cell] = -1


def no_number(distance, following, cell, far):
    distance[cell] = math.nan


def cut_off(distance, following, cell, far):
    distance[cell] = math.inf


def longer(distance, following, cell, far):
    distance += 0.1


def another_end(distance, following, cell, far):
    distance[:] = np.roll(distance, 1)


@pytest.mark.parametrize(
    "change", [shorter, through_a_wall, beyond, in_a_circle, early, no_number, cut_off, longer, another_end]
)
def test_what_is_not_true_is_not_taken(ground, tmp_path, change):
    ends = ground.every()[0]
    made = ground.ways.field(ends)
    distance, following = np.array(made.distance), np.array(made.following)
    far, cell = np.argsort(np.where(np.isfinite(distance), distance, -1))[[-1, -9]]
    change(distance, following, cell, far)
    schema = stored_distance_fields._schema(len(distance))
    lists = [pa.FixedSizeListArray.from_arrays(pa.array(each), len(distance)) for each in (distance, following)]
    batch = pa.RecordBatch.from_arrays([pa.array([ends], schema.field("ends").type), *lists], schema=schema)
    with pa.ipc.new_file(str(stored_distance_fields.file_of(ground.ways, tmp_path)), schema) as file:
        file.write_batch(batch)
    assert stored_distance_fields.StoredWays(Ways(ground.floor), tmp_path).field(ends) is None


@pytest.mark.parametrize("data", [b"", b"ARROW1", b"\0" * 4096])
def test_a_file_that_is_none_of_ours_is_left_alone(ground, tmp_path, data):
    stored_distance_fields.file_of(ground.ways, tmp_path).write_bytes(data)
    assert stored_distance_fields.StoredWays(ground.ways, tmp_path).field(ground.every()[0]) is None


def test_a_file_that_is_cut_short(ground, tmp_path):
    file = stored_distance_fields.store(ground.ways, ground.every()[:2], tmp_path)
    whole = file.read_bytes()
    for share in (0.1, 0.5, 0.9, 0.99):
        file.write_bytes(whole[: int(share * len(whole))])
        assert stored_distance_fields.StoredWays(ground.ways, tmp_path).field(ground.every()[0]) is None


def test_ways_of_homes_by_their_floors(tmp_path, monkeypatch):
    wanted = [Wanted(name, library.load_graph(name, default()), default, tmp_path) for name in ("maple", "cedar")]
    monkeypatch.setattr("hearth.simulation.motion.ground.Ground.every", lambda ground: [ground.stands(1)])
    one, other = make(wanted)
    assert (one.home, one.fields, other.home) == ("maple", 1, "cedar") and one.file != other.file
    assert sorted(path.stat().st_size for path in tmp_path.iterdir()) == sorted((one.bytes, other.bytes))


def test_the_folder_is_the_user_s(monkeypatch, tmp_path):
    assert stored_distance_fields.folder().name == "ways"
    monkeypatch.setenv(stored_distance_fields.VARIABLE, str(tmp_path))
    assert stored_distance_fields.folder() == tmp_path


def test_a_folder_that_cannot_be_written(ground, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(HearthError) as raised:
        stored_distance_fields.store(ground.ways, ground.every()[:1], tmp_path / "file")
    assert raised.value.diagnostics[0].code == Code.UNWRITABLE


def test_a_graph_without_boxes(tmp_path):
    from dataclasses import replace

    graph = library.load_graph("maple", default())
    bare = replace(graph, nodes=tuple(replace(node, box=None) for node in graph.nodes))
    with pytest.raises(HearthError, match="without boxes"):
        list(make([Wanted("maple", bare, default, tmp_path)]))
    assert Home.from_graph(bare, "maple", default())
