"""A disk that is full, and what is drawn by chance."""

import errno
from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("open3d", exc_type=ImportError)

from hearth.kb.loading.load import default
from hearth.rendering.cameras.camera import look_at
from hearth.rendering.film.video_file import Writer
from hearth.rendering.scene.film_variation import PLAIN, drawn, scattered
from hearth.rendering.scene.home_geometry import with_geometry
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node

TABLE = Node(1, "table", "Furniture", ("SURFACES",), box=Box((0, 0.37, 0), (1.2, 0.74, 0.8)))
CUPS = tuple(
    Node(2 + k, "cup", "Props", ("GRABBABLE",), box=Box((-0.4 + 0.2 * k, 0.79, 0.1), (0.08, 0.1, 0.08)))
    for k in range(4)
)
HOME = EnvironmentGraph((TABLE, *CUPS), tuple(Edge(cup.id, "ON", 1) for cup in CUPS))


def test_a_film_that_could_not_be_written_leaves_the_complete_one(tmp_path):
    film = tmp_path / "auto.mp4"
    film.write_bytes(b"an earlier one")
    writer = Writer(film, 32, 24, 5)
    writer.add(np.zeros((24, 32, 3), np.uint8))
    writer._wait(0)
    writer.file.release()
    writer.part.write_bytes(b"")
    with pytest.raises(HearthError, match="nothing could be written"):
        writer.close()
    assert film.read_bytes() == b"an earlier one"


@pytest.mark.parametrize("size", [(33, 24), (32, 23)])
def test_a_film_of_an_odd_size_is_refused_rather_than_cut(tmp_path, size):
    with pytest.raises(HearthError, match="a video can't have") as refused:
        Writer(tmp_path / "auto.mp4", *size, 5)
    assert refused.value.diagnostics[0].suggestion.startswith("32 by ")
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize("suffix", [".webm", ".mp4"])
def test_equal_films_are_equal_bytes(tmp_path, suffix):
    import cv2

    films = [tmp_path / f"{name}{suffix}" for name in ("one", "other")]
    for film in films:
        writer = Writer(film, 64, 48, 10)
        for level in range(0, 240, 20):
            writer.add(np.full((48, 64, 3), level, np.uint8))
        writer.close()
    assert films[0].read_bytes() == films[1].read_bytes()
    read = cv2.VideoCapture(str(films[0]))
    assert sum(read.read()[0] for _ in range(20)) == 12, "it can still be played"


def test_small_things_are_moved_on_their_support_and_not_into_each_other():
    how = drawn(3, "a program")
    moved = {node.id: node.box for node in scattered(HOME, how).nodes}
    assert moved[1] == TABLE.box
    assert any(moved[cup.id] != cup.box for cup in CUPS)
    for cup in CUPS:
        assert abs(moved[cup.id].center[0]) + 0.04 <= 0.6
        assert abs(moved[cup.id].center[2]) + 0.04 <= 0.4
        for other in CUPS:
            if other.id > cup.id:
                apart = np.abs(np.subtract(moved[cup.id].center, moved[other.id].center))
                assert apart[0] >= 0.08 or apart[2] >= 0.08
    assert scattered(HOME, PLAIN) is HOME


def test_chance_is_the_same_for_the_same_seed_and_is_told():
    assert drawn(3, "a") == drawn(3, "a")
    assert drawn(3, "a") != drawn(3, "b")
    assert set(drawn(3, "a").row()) == {"seed", "hour", "speed", "jitter", "scatter", "wander"}
    camera = look_at("kitchen.1", (0, 1, 0), (0, 1, 5))
    how = drawn(3, "a")
    assert how.moved(camera) == how.moved(camera) != camera
    assert np.abs(np.subtract(how.moved(camera).eye, camera.eye)).max() <= how.jitter


def test_a_stage_goes_on_after_a_full_disk(tmp_path, monkeypatch):
    from hearth.pipelines import render as rendering
    from hearth.pipelines.engine.runner import run_stage
    from hearth.pipelines.engine.settings import Settings
    from hearth.pipelines.engine.stages import stage

    program = tmp_path / "bed.txt"
    program.write_text("Rest\nLie down.\n\n[Walk] <bed> (1)\n")
    settings = Settings((str(program),), str(tmp_path / "out"), homes=("maple",), pictures=1, variants=0)
    for name in ("ingest", "validate", "sample", "augment"):
        run_stage(stage(name), settings)
    wrote = []

    def full(path, data):
        if len(wrote) == 3:
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        wrote.append(path)
        path.write_bytes(data)

    monkeypatch.setattr(rendering, "write_bytes", full)
    with pytest.raises(HearthError, match="No space left"):
        run_stage(stage("render"), settings)
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in wrote)
    monkeypatch.undo()
    assert run_stage(stage("render"), settings).manifest.counts.rows[""] == 8


def test_a_home_without_geometry_is_laid_out_and_said():
    bare = EnvironmentGraph(
        (Node(9, "kitchen", "Rooms"), *(replace(node, box=None) for node in HOME.nodes)),
        (*HOME.edges, *(Edge(node.id, "INSIDE", 9) for node in HOME.nodes)),
    )
    found = with_geometry(bare, "bare", default())
    assert found.made
    assert [node.id for node in found.graph.nodes] == [node.id for node in bare.nodes]
    assert all(node.box for node in found.graph.nodes)
    assert "bare has no geometry" in found.note("bare")
    again = with_geometry(found.graph, "", default())
    assert again.graph is found.graph, "what has geometry keeps its own"
    assert not again.note("bare")
