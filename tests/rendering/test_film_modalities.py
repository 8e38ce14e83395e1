"""Films with every modality: what is read back equals what a picture of the frame has."""

import json
from itertools import pairwise

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.execution_pictures import snapshots
from hearth.rendering.film.modality_archives import pictures_in
from hearth.rendering.film.video import film, record
from hearth.rendering.modalities import MODALITIES, PICTURES
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home

HOW = {"size": (48, 36), "fps": 2.0}
EVERY = [*MODALITIES, "graph"]


def sat(graph):
    program, _ = parse_program("Sit\nRest.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n")
    return attempt(program, Home.from_graph(graph, "maple", default())).execution


@pytest.fixture(scope="module")
def filmed():
    graph = library.load_graph("maple", default())
    return graph, trajectory_of(sat(graph), graph, default())


def test_every_modality_of_every_frame_is_written(filmed, tmp_path):
    graph, trajectory = filmed
    done = record(trajectory, graph, tmp_path, "auto", suffixes=(".webm",), modalities=EVERY, **HOW)
    assert {path.name for path in tmp_path.iterdir()} == {path.name for path in (*done.files, *done.further)}
    index = json.loads((tmp_path / "auto.index.json").read_text())
    assert set(index["files"]) == set(EVERY) - {"rgb"}
    assert len(index["frames"]) == done.frames
    assert [step["tick"] for step in index["steps"]] == [0, 1, 2]
    assert [step["visible"] is None for step in index["steps"]] == [True, False, False], "the start names nothing"
    for name, file in index["files"].items():
        written = list(pictures_in(tmp_path / file)) if name in PICTURES else (tmp_path / file).read_text().splitlines()
        assert len(written) == done.frames, name
    frames = list(film(trajectory, graph, "auto", **HOW))
    for name in ("depth", "instance_ids"):
        for frame, picture in zip(frames, pictures_in(tmp_path / f"auto.{name}.zip"), strict=True):
            assert (frame.pictures([name])[name] == picture).all()
    assert [frame["tick"] for frame in index["frames"]] == [frame.frame.tick for frame in frames]


def test_flow_is_towards_the_next_frame(filmed):
    graph, trajectory = filmed
    moving = [f for f in film(trajectory, graph, "auto", **HOW) if f.frame.tick == 1]
    person = moving[0].frame.actors[0].node.id
    found = [frame.pictures(["flow", "instance_ids"]) for frame in moving]
    shifts = [np.nan_to_num(each["flow"][each["instance_ids"] == person]) for each in found]
    assert max(np.abs(shift).max(initial=0) for shift in shifts) > 0.5


@pytest.mark.parametrize("view", ["first", "third"])
def test_flow_is_as_the_next_camera_sees_it(filmed, view):
    """Things that stand still are seen by the next frame's camera where the flow takes them."""
    graph, trajectory = filmed
    frames = [f for _, f in zip(range(8), film(trajectory, graph, view, **HOW), strict=False)]
    turned = [(a, b) for a, b in pairwise(frames) if a.camera != b.camera]
    assert turned
    for one, other in turned:
        shot, found = one.shot, one.pictures(["flow"])["flow"].reshape(-1, 2)
        static = (shot.hits.triangle >= 0) & (shot.hits.triangle < shot.geometry.first) & np.isfinite(found[:, 0])
        points = (shot.rays[:, :3] + shot.rays[:, 3:] * shot.hits.distance[:, None])[static]
        there = other.camera.project(points.astype(np.float64))[0]
        rows, columns = np.divmod(np.flatnonzero(static), shot.camera.width)
        assert len(rows) and np.abs(np.stack((columns, rows), 1) + 0.5 + found[static] - there).max() < 0.1
    assert max(np.nanmax(np.abs(one.pictures(["flow"])["flow"])) for one, _ in turned) > 1


def test_no_flow_is_known_across_a_cut():
    graph = library.load_graph("maple", default())
    program, _ = parse_program("Move on\nx\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]\n[Walk] <fridge> (1)\n")
    execution = attempt(program, Home.from_graph(graph, "maple", default())).execution
    trajectory, cuts = trajectory_of(execution, graph, default()), 0
    for one, other in pairwise(film(trajectory, graph, "auto", size=(24, 18), fps=2.0)):
        unknown = np.isnan(one.pictures(["flow"])["flow"])
        cut = one.camera != other.camera
        assert unknown.all() == cut
        cuts += cut
    assert cuts


def test_classes_of_films_and_snapshots_have_the_numbers_of_the_vocabulary(filmed):
    graph, trajectory = filmed
    frame = next(film(trajectory, graph, "auto", **HOW))
    (start, *_) = snapshots(sat(graph), graph, default(), ["auto"], ("class_ids", "instance_ids"), size=HOW["size"])
    for found in (frame.pictures(["class_ids", "instance_ids"]), start.pictures):
        wanted = {thing.id: default().objects[thing.class_name].id for thing in frame.frame.scene.everything}
        ids, places = np.unique(found["instance_ids"], return_inverse=True)
        classes = np.array([wanted.get(node, 0) for node in ids.tolist()])
        assert len(ids) > 3 and (classes[places.reshape(found["class_ids"].shape)] == found["class_ids"]).all()


def test_the_same_film_has_the_same_bytes(filmed, tmp_path):
    graph, trajectory = filmed
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        record(trajectory, graph, tmp_path / name, "top", modalities=["depth", "flow", "boxes"], **HOW)
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert len(files) == 2 + 3 + 1
    for file in files:
        assert (tmp_path / "one" / file).read_bytes() == (tmp_path / "other" / file).read_bytes(), file


def test_fine_films_are_drawn_finely(filmed):
    graph, trajectory = filmed
    draft = next(film(trajectory, graph, "auto", **HOW)).rgb
    fine = next(film(trajectory, graph, "auto", quality="fine", **HOW)).rgb
    assert draft.shape == fine.shape
    assert (draft != fine).mean() > 0.2


def test_unknown_modalities_are_refused_before_anything_is_written(filmed, tmp_path):
    graph, trajectory = filmed
    with pytest.raises(HearthError, match="unknown modality or quality: smell"):
        record(trajectory, graph, tmp_path, "auto", modalities=["smell"], **HOW)
    assert not list(tmp_path.iterdir())
