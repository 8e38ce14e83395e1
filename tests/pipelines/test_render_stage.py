"""The render stage: pictures of a short program in one of our homes, and the rows about them."""

from __future__ import annotations

import pytest

from hearth.storage.files import file_digest


@pytest.fixture(scope="module")
def filmed(tmp_path_factory, build_folder):
    pytest.importorskip("open3d", exc_type=ImportError)
    folder = tmp_path_factory.mktemp("filmed")
    program = folder / "bed.txt"
    program.write_text("Rest\nLie down.\n\n[Walk] <bed> (1)\n")
    built = build_folder(
        folder / "out",
        [program],
        homes=("maple",),
        homes_folder=None,
        pictures=1,
        videos=1,
        clips=1,
        demonstrations=1,
        variants=0,
    )
    return built.run_all()


def test_a_picture_a_tick_camera_and_modality(filmed):
    rows = filmed.rows("render")
    assert [(row["tick"], row["file"].split(".")[-3], row["modality"]) for row in rows] == [
        (tick, view, modality) for tick in (0, 1) for view in ("top", "auto") for modality in ("rgb", "instance_ids")
    ]
    for row in rows:
        assert (filmed.out / "render" / row["file"]).read_bytes().startswith(b"\x89PNG")
        assert len(row["pose"]) == 16
        assert row["intrinsics"]["fx"] > 0


def test_a_film_has_its_steps_its_cameras_and_what_was_drawn_by_chance(filmed):
    (row,) = filmed.rows("render/videos")
    film = (filmed.out / "render" / row["file"]).read_bytes()
    assert len(film) > 1000 and row["file"].endswith(".webm")
    assert row["frames"] == pytest.approx(row["seconds"] * row["fps"])
    assert [step["tick"] for step in row["steps"]] == [0, 1]
    assert row["steps"][1]["steps"][0].startswith("[Walk] <bed>")
    assert row["steps"][1]["end"] == pytest.approx(row["seconds"], abs=0.1)
    assert row["steps"][1]["visible"] == 1.0
    assert row["track"][0]["frame"] == 0
    assert len(row["track"][0]["pose"]) == 16
    assert 7.5 <= row["variation"]["hour"] <= 18.5


def test_clips_have_their_arrays_and_what_is_done(filmed):
    import numpy as np

    import hearth

    rows = filmed.rows("render/clips")
    assert [(row["tick"], row["action"], row["objects"], row["kind"]) for row in rows] == [
        (1, "Walk", ["bed"], "seen")
    ] * len(rows)
    assert 1 <= len(rows) <= 5 and [row["number"] for row in rows] == [*range(len(rows))]
    with np.load(filmed.out / "render" / rows[0]["file"], allow_pickle=False) as file:
        assert sorted(file) == rows[0]["modalities"]
        assert file["class_ids"].shape[0] >= rows[-1]["first"] + rows[-1]["frames"]
    ds = hearth.load(filmed.out)
    assert ds.rows("SELECT count(*), any_value(home) FROM clips")[1] == [(len(rows), "maple")]
    assert (ds.folder / rows[0]["file"]).is_file()


def test_films_are_published_and_counted(filmed):
    import hearth

    ds = hearth.load(filmed.out)
    (row,) = ds.rows("SELECT file, home, seconds FROM videos")[1]
    assert row[1] == "maple"
    assert file_digest(ds.folder / row[0]) == file_digest(filmed.out / "render" / row[0])


def test_pictures_are_published_with_the_dataset(filmed):
    import hearth

    ds = hearth.load(filmed.out)
    _, found = ds.rows("SELECT f.file, e.program_id FROM frames f JOIN executions e USING (execution_id)")
    assert {program for _, program in found} == {"text:bed.txt"}
    for file, _ in found:
        assert file_digest(ds.folder / file) == file_digest(filmed.out / "render" / file)
        assert ds.manifest["files"][file]["sha256"] == file_digest(ds.folder / file)


def test_what_has_no_geometry_is_not_chosen(made):
    from hearth.pipelines.render import prepare

    assert prepare(made.settings)["executions"] == {}


def test_clips_are_read_as_arrays(filmed):
    import numpy as np

    import hearth
    from hearth.models.films.clip_data import Clips
    from hearth.models.films.film_arrays import COLOURS
    from hearth.schemas.diagnostics import HearthError

    ds = hearth.load(filmed.out)
    part = filmed.rows("render/clips")[0]["part"]
    clips = Clips.of(ds, part)
    person = dict(ds.rows("SELECT name, id FROM vocabulary WHERE kind = 'class'")[1])["character"]
    film = clips.films[0]
    assert film.shape[1:] == (96, 128)
    last = max(clip.first for clip in clips.clips if clip.film == 0)
    assert clips.frames == 9
    assert len(film) >= last + 9
    assert np.mean(film == person) > 0.001
    with pytest.raises(HearthError, match="no clips with `rgb`"):
        Clips.of(ds, part, array=COLOURS)
    with pytest.raises(HearthError, match="of the part"):
        Clips.of(ds, {"train": "test"}.get(part, "train"))


def test_demonstrations_have_a_picture_a_tick_from_above(filmed):
    import numpy as np

    import hearth

    rows = filmed.rows("render/demonstration_frames")
    assert [(row["tick"], row["index"], row["width"], row["height"]) for row in rows] == [
        (0, 0, 320, 240),
        (1, 1, 320, 240),
    ]
    with np.load(filmed.out / "render" / rows[0]["file"], allow_pickle=False) as file:
        assert file["class_ids"].shape == (2, 240, 320)
        assert file["rgb_changes"].shape == (2, 240, 320, 3)
    ds = hearth.load(filmed.out)
    assert ds.rows("SELECT count(*), any_value(home) FROM demonstration_frames")[1] == [(2, "maple")]
    assert (ds.folder / rows[0]["file"]).is_file()
    assert hearth.verify(filmed.out).faults == ()


def test_pictures_are_exported_as_instances_of_coco(filmed, tmp_path):
    import json

    import numpy as np

    import hearth
    from hearth.rendering.film.png import decode

    dataset = hearth.load(filmed.out)
    assert hearth.export(dataset, "coco", tmp_path / "coco") == 4  # two ticks by two cameras
    found = json.loads((tmp_path / "coco/instances.json").read_text())
    names = {each["id"]: each["name"] for each in found["categories"]}
    rows = {(row["tick"], row["camera"], row["modality"]): row["file"] for row in filmed.rows("render")}
    known = dataset.rows("SELECT name FROM vocabulary WHERE kind = 'class'")[1]
    assert {*names.values()} == {name for (name,) in known}
    lines = [json.loads(line) for line in (tmp_path / "coco/images/metadata.jsonl").read_text().splitlines()]
    assert lines == found["images"]
    for image in found["images"]:
        picture, mask = (rows[image["tick"], image["camera"], name] for name in ("rgb", "instance_ids"))
        copied = (tmp_path / "coco/images" / image["file_name"]).read_bytes()
        assert copied == (filmed.out / "render" / picture).read_bytes()
        mask = decode((filmed.out / "render" / mask).read_bytes())
        classes = {node.id: node.class_name for node in dataset["text:bed.txt"].runs[0].graph(image["tick"]).nodes}
        mine = [each for each in found["annotations"] if each["image_id"] == image["id"]]
        assert {each["node_id"] for each in mine} == {*np.unique(mask).tolist()} & classes.keys() != set()
        for each in mine:
            flat = np.repeat(np.arange(len(each["segmentation"]["counts"])) % 2, each["segmentation"]["counts"])
            shown = flat.reshape(each["segmentation"]["size"], order="F") == 1
            assert (shown == (mask == each["node_id"])).all() and each["area"] == shown.sum()
            assert names[each["category_id"]] == classes[each["node_id"]]
            left, top, width, height = each["bbox"]
            assert shown[top : top + height, left : left + width].sum() == each["area"]
            assert shown[top].any() and shown[top + height - 1].any()
    assert [each["id"] for each in found["annotations"]] == [*range(1, len(found["annotations"]) + 1)]
