"""The render stage: pictures of a short program in one of our homes, and the rows about them."""

from __future__ import annotations

import pytest

from hearth.pipelines.files import file_digest


@pytest.fixture(scope="module")
def filmed(tmp_path_factory, build_folder):
    pytest.importorskip("open3d", exc_type=ImportError)
    folder = tmp_path_factory.mktemp("filmed")
    program = folder / "bed.txt"
    program.write_text("Rest\nLie down.\n\n[Walk] <bed> (1)\n")
    built = build_folder(folder / "out", [program], homes=("maple",), homes_folder=None, pictures=1, variants=0)
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
