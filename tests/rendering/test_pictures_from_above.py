"""Pictures from above: they are those of `render`, their masks are the classes of its ids, and equal runs give equal
bytes."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest

import hearth
from hearth.homes import library
from hearth.kb.loading.load import default

pytest.importorskip("open3d", exc_type=ImportError)

from hearth.rendering.film import pictures_from_above
from hearth.rendering.film.execution_pictures import snapshots
from hearth.rendering.scene.home_geometry import with_geometry

TEXT = "Rest\nSit down.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]\n"


@pytest.fixture(scope="module")
def performed():
    world = hearth.World.start(hearth.home("maple"))
    program = hearth.parse_program(TEXT)
    execution = hearth.run(world, hearth.bind(program, world).apply(program))
    return execution, with_geometry(library.load_graph("maple", default(), None), "maple", default()).graph


def _numbers():
    return {thing.name: thing.id for thing in default().objects.values()}


@pytest.fixture(scope="module")
def found(performed):
    return pictures_from_above.demonstration(*performed, default(), _numbers())


def test_there_is_a_picture_at_the_start_and_after_each_tick(found):
    assert found.rgb.shape == (4, 240, 320, 3) and found.rgb.dtype == np.uint8
    assert found.class_ids.shape == (4, 240, 320) and found.class_ids.dtype == np.uint16


def test_masks_are_the_classes_of_the_nodes_that_the_renderer_names(performed, found):
    shots = [*snapshots(*performed, default(), ["top"], ["rgb", "instance_ids", "graph"])]
    for number, shot in enumerate(shots):
        graph = shot.pictures["graph"]
        classes = {node["id"]: node["class_name"] for node in graph["nodes"]}
        wanted = np.zeros(1 << 16, np.uint16)
        for node, name in classes.items():
            wanted[node] = _numbers().get(name, 0)
        ids = shot.pictures["instance_ids"]
        assert np.mean(wanted[ids] != found.class_ids[number]) < 0.001
        assert np.array_equal(shot.pictures["rgb"], found.rgb[number])


def test_who_acts_is_seen_where_they_are(found):
    person = _numbers()["character"]
    seen = found.class_ids == person
    assert seen.any((1, 2)).all()
    assert (seen[0] != seen[1]).any()


def test_the_same_run_gives_the_same_bytes_and_they_are_read_back(performed, found):
    again = pictures_from_above.demonstration(*performed, default(), _numbers())
    data = pictures_from_above.stored(found)
    assert data == pictures_from_above.stored(again)
    with np.load(BytesIO(data), allow_pickle=False) as arrays:
        assert np.array_equal(arrays["class_ids"], found.class_ids)
        assert np.array_equal(np.cumsum(arrays["rgb_changes"], axis=0, dtype=np.uint8), found.rgb)
