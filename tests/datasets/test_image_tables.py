"""Pictures of `frames` as values: the bytes of their files, read by Hugging Face's library from any folder."""

from __future__ import annotations

import importlib
import shutil

import orjson
import pyarrow.parquet as pq
import pytest

import hearth
from hearth.datasets.format.card import write_card
from hearth.datasets.format.image_tables import FOLDER, write_images
from hearth.datasets.verify import verify
from hearth.pipelines.engine.tables_by_part import write_split_rows
from hearth.schemas.tables import TABLES
from hearth.storage.files import file_digest

SIZE = 6, 4
"""Width and height of the pictures."""


@pytest.fixture
def folder(made, tmp_path):
    """A dataset with two pictures of an execution in train and one of an execution without a part."""
    from PIL import Image

    copy = shutil.copytree(made.out / "publish", tmp_path / "copy")
    runs = hearth.load(copy).rows("SELECT execution_id, home FROM executions WHERE executable ORDER BY 1")[1]
    rows = []
    for number, (part, (execution_id, home)) in enumerate(zip(("train", "train", None), runs, strict=False)):
        name = f"frames/one/{number:03d}.top.rgb.png"
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        Image.new("RGB", SIZE, (number, 100, 200)).save(copy / name)
        rows.append((part, frame(execution_id, home, name)))
    write_split_rows(copy, "frames", TABLES["frames"], rows)
    write_images(copy)
    write_card(copy)
    return believed(copy)


def frame(execution_id, home, name):
    plain = {"width": SIZE[0], "height": SIZE[1], "pose": [0.0] * 16, "layout_made": False, "home": home}
    lens = dict.fromkeys(("fx", "fy", "cx", "cy"), 1.0)
    return {"execution_id": execution_id, "tick": 0, "camera": "top", "modality": "rgb", "intrinsics": lens,
            "start_time": None, "end_time": None, "file": name, **plain}  # fmt: skip


def believed(folder):
    """Make the manifest say what the folder now has."""
    manifest = orjson.loads((folder / "manifest.json").read_bytes())
    for path in (path for path in folder.rglob("*") if path.is_file()):
        name = path.relative_to(folder).as_posix()
        if name in manifest["files"] or name.startswith("frames/"):
            manifest["files"][name] = {"bytes": path.stat().st_size, "sha256": file_digest(path)}
    (folder / "manifest.json").write_bytes(orjson.dumps(manifest))
    return folder


def test_a_picture_is_the_bytes_of_its_file_in_the_file_of_its_part(folder):
    assert sorted(path.name for path in (folder / FOLDER).iterdir()) == [
        "part-00000.left_out.parquet",
        "part-00000.train.parquet",
    ]
    for path in (folder / FOLDER).iterdir():
        for row in pq.read_table(path).to_pylist():
            assert row["image"] == {"path": row["file"], "bytes": (folder / row["file"]).read_bytes()}


def test_queries_read_the_table_without_the_pictures(folder):
    ds = hearth.load(folder)
    assert ds.rows("SELECT count(*) FROM frames")[1] == [(3,)]
    assert "image" not in ds.frames.columns


def test_it_is_verified(folder):
    assert verify(folder).faults == ()


@pytest.mark.parametrize("column", ["bytes", "path", "tick"])
def test_a_picture_other_than_its_file_is_a_fault(folder, column):
    path = folder / FOLDER / "part-00000.train.parquet"
    table = pq.read_table(path)
    rows = table.to_pylist()
    (rows[1] if column == "tick" else rows[1]["image"])[column] = 7 if column == "tick" else rows[0]["image"][column]
    pq.write_table(table.from_pylist(rows, table.schema), path)
    (fault,) = verify(believed(folder)).faults
    assert str(fault.code) == "BAD_TABLE" and fault.file == str(path)
    assert (
        "other rows" if column == "tick" else f"1 pictures have other bytes than their files, first `{rows[1]['file']}`"
    ) in fault.message


@pytest.mark.tools
def test_load_dataset_gives_images_from_any_folder_without_the_network(folder, tmp_path, monkeypatch):
    pytest.importorskip("datasets.config", reason="the library `datasets` is not installed")
    library = importlib.import_module("datasets")
    monkeypatch.setattr("datasets.config.HF_HUB_OFFLINE", True)
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    for place in (str(folder), "../copy"):
        loaded = library.load_dataset(place, "frames", cache_dir=str(tmp_path / "cache"))
        assert loaded["train"].features["image"] == library.Image()
        assert [row["image"].getpixel((1, 1)) for row in loaded["train"]] == [(0, 100, 200), (1, 100, 200)]
        assert [row["image"].size for row in loaded["rows"]] == [SIZE] * 3
