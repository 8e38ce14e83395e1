"""Clips of films: their labels, their frames, and what the masks hold."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from types import SimpleNamespace

import numpy as np
import pytest

import hearth
from hearth.homes import library
from hearth.kb.loading.load import default

pytest.importorskip("open3d", exc_type=ImportError)

from hearth.rendering.film import clips
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.video import CameraSelector
from hearth.rendering.modalities import render
from hearth.rendering.people.motion import frames
from hearth.rendering.scene.home_geometry import with_geometry

TEXT = "Rest\nSit down.\n\n\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]\n"


@pytest.fixture(scope="module")
def numbers():
    return {thing.name: thing.id for thing in default().objects.values()}


@pytest.fixture(scope="module")
def trajectory():
    world = hearth.World.start(hearth.home("maple"))
    program = hearth.parse_program(TEXT)
    execution = hearth.run(world, hearth.bind(program, world).apply(program))
    home = with_geometry(library.load_graph("maple", default(), None), "maple", default()).graph
    return trajectory_of(execution, home, default()), home


@pytest.fixture(scope="module")
def film(trajectory, numbers):
    return clips.clip_film(*trajectory, numbers, clips.MODALITIES)


def test_a_clip_is_nine_whole_frames_and_its_middle_is_its_step(trajectory, film):
    shown = [*frames(trajectory[0], clips.RATE)]
    assert {len(pictures) for pictures in film.pictures.values()} == {len(shown)}
    for clip in film.clips:
        assert 0 <= clip.first <= len(shown) - clips.FRAMES
        middle = shown[clip.first + clips.FRAMES // 2]
        assert (middle.tick, middle.steps[0].action) == (clip.tick, clip.step.action)
        assert [ref.node for ref in middle.steps[0].objects] == [ref.node for ref in clip.step.objects]


def test_a_clip_names_what_its_masks_show(film, numbers):
    (sits, *_) = (clip for clip in film.clips if clip.step.action == "Sit")
    masks = film.pictures[clips.MASKS][sits.first : sits.first + clips.FRAMES]
    assert (masks == numbers[sits.step.objects[0].name]).any()


def test_each_step_has_one_to_five_clips(film):
    ticks = [clip.tick for clip in film.clips]
    assert {*ticks} == {1, 2, 3}
    assert max(map(ticks.count, ticks)) <= clips.MOST
    assert len({clip.first for clip in film.clips}) == len(film.clips)


def test_pictures_are_those_of_render(trajectory, film, numbers):
    moving, home = trajectory
    selector = CameraSelector(moving, home, "auto", clips.SIZE)
    for number, frame in enumerate(frames(moving, clips.RATE)):
        camera = selector.camera(frame)
        if number % 7 == 0:
            found = render(frame.scene, camera, clips.MODALITIES, class_ids=numbers)
            for name in clips.MODALITIES:
                assert np.mean(found[name] != film.pictures[name][number]) < 0.002, (number, name)


def test_masks_alone_are_the_same_masks(trajectory, film, numbers):
    alone = clips.clip_film(*trajectory, numbers)
    assert np.mean(alone.pictures[clips.MASKS] != film.pictures[clips.MASKS]) < 0.002
    assert alone.clips == film.clips and alone.pictures.keys() == {clips.MASKS}


def test_the_file_is_read_without_pickle_and_has_equal_bytes(film):
    data = clips.stored(film)
    assert data == clips.stored(film)
    with np.load(BytesIO(data), allow_pickle=False) as file:
        assert {name: (file[name].dtype.name, file[name].shape[1:]) for name in file} == {
            "class_ids": ("uint16", (96, 128)),
            "depth": ("uint16", (96, 128)),
            "rgb": ("uint8", (96, 128, 3)),
        }


def test_what_two_agents_do_at_once_is_in_no_clip():
    (step,) = hearth.parse_program("A\nb\n\n\n[StandUp]\n").steps
    other = replace(step, agent=1)
    acts = {0: (), 1: (step,), 2: (step, other), 3: (other,)}
    kept = [(SimpleNamespace(tick=k // 12, steps=acts[k // 12]), SimpleNamespace(name="a")) for k in range(48)]
    found = [*clips._clips(kept, {})]
    assert {(clip.tick, clip.step.agent) for clip in found} == {(1, 0), (3, 1)}


def test_objects_have_the_classes_that_masks_show():
    step = hearth.parse_program("A\nb\n\n\n[PutBack] <mug> (1) <table> (1)\n").steps[0]
    mug, table = step.objects
    bound = replace(step, objects=(replace(mug, node=4), replace(table, node=5)))
    named = clips.by_class(bound, {5: "kitchen_table"})
    assert [(ref.name, ref.node) for ref in named.objects] == [("mug", 4), ("kitchen_table", 5)]
