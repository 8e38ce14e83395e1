"""Archives of a great many files are refused before their files are looked at, and before their list is read."""

from __future__ import annotations

import io
import time
import zipfile

import numpy as np
import pytest

from hearth.models.films.film_arrays import film_array
from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items
from hearth.pipelines.readers import recognition_by_content
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage import archives

PROGRAM = "Sleep\nGo to bed.\n\n\n[Walk] <bed> (1)\n[Lie] <bed> (1)\n"
MOST = 20


@pytest.fixture
def few(monkeypatch):
    monkeypatch.setattr(recognition_by_content, "MOST_MEMBERS", MOST)


def packed(path, count, name="{}.txt"):
    with zipfile.ZipFile(path, "w") as archive:
        for number in range(count):
            archive.writestr(name.format(number), PROGRAM.replace("Sleep", f"Sleep {number}"))
    return path


def scanned(path):
    return [item for _, item in items(labelled([str(path)]))]


def refusal(path):
    with pytest.raises(HearthError) as found:
        scanned(path)
    return found.value.diagnostics[0]


def test_an_archive_has_at_most_so_many_files(tmp_path, few):
    assert len(scanned(packed(tmp_path / "a.zip", MOST))) == MOST
    fault = refusal(packed(tmp_path / "b.zip", MOST + 1))
    assert fault.code == Code.FILE_TOO_LARGE and "21 files" in fault.message and "unpack" in fault.suggestion


def test_a_file_of_the_archive_is_opened_only_if_all_may_be(tmp_path, few, monkeypatch):
    path = packed(tmp_path / "a.zip", 60)
    monkeypatch.setattr(zipfile.ZipFile, "open", lambda *_: pytest.fail("a file was opened"))
    assert refusal(path).code == Code.FILE_TOO_LARGE


def test_one_among_other_sources_is_one_reject(tmp_path, few):
    folder = tmp_path / "sources"
    folder.mkdir()
    (folder / "good.txt").write_text(PROGRAM)
    packed(folder / "many.zip", 60)
    found = {item.place: item.reader for item in scanned(folder)}
    assert found.pop("sources/many.zip") == "refused" and [*found] == ["sources/good.txt"]


def test_hidden_files_and_those_of_a_release_do_not_count(tmp_path, few):
    path = packed(tmp_path / "a.zip", 3)
    with zipfile.ZipFile(path, "a") as archive:
        for number in range(60):
            archive.writestr(f"__MACOSX/._{number}.txt", "")
    assert len(scanned(path)) == 3


@pytest.mark.parametrize("comment", [b"", b"PK\x05\x06" + b"\0" * 18, b"PK\x06\x06" + b"\0" * 52])
def test_a_list_of_files_that_is_too_long_is_not_read(tmp_path, monkeypatch, comment):
    path = packed(tmp_path / "a.zip", 40, "{}" + "x" * 50)
    with zipfile.ZipFile(path, "a") as archive:
        archive.comment = comment
    monkeypatch.setattr(archives, "LARGEST_DIRECTORY", 2_000)
    fault = refusal(path)
    assert fault.code in (Code.FILE_TOO_LARGE, Code.BAD_ARCHIVE)
    assert fault.code == Code.FILE_TOO_LARGE or comment.startswith(b"PK\x05")


def test_a_film_is_no_archive_of_many_files(monkeypatch):
    data = io.BytesIO()
    np.savez(data, class_ids=np.ones((1, 2, 2), np.uint16), **{f"a{n}": np.zeros(1) for n in range(40)})
    assert film_array(data, "a.npz").shape == (1, 2, 2)
    monkeypatch.setattr(archives, "LARGEST_DIRECTORY", 2_000)
    with pytest.raises(HearthError) as found:
        film_array(data, "a.npz")
    assert found.value.diagnostics[0].code == Code.FILE_TOO_LARGE and not data.closed


@pytest.mark.slow
def test_a_hundred_thousand_files_are_refused_in_seconds(tmp_path):
    path = packed(tmp_path / "a.zip", 100_000)
    began = time.process_time()
    assert refusal(path).code == Code.FILE_TOO_LARGE
    assert time.process_time() - began < 10


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", ["a.txt", "withoutconds/a/1.txt"])
def test_two_files_of_one_name_are_refused(tmp_path, name):
    """The second was read twice, and the first lost."""
    with zipfile.ZipFile(tmp_path / "twice.zip", "w") as file:
        for title in ("Watch TV", "Read book"):
            file.writestr(name, f"{title}\n\n\n\n[Walk] <couch> (1)\n")
    fault = refusal(tmp_path / "twice.zip")
    assert fault.code is Code.BAD_ARCHIVE and f"2 files in it have the name `{name}`" in fault.message


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_a_folder_may_be_listed_twice(tmp_path):
    with zipfile.ZipFile(tmp_path / "folders.zip", "w") as file:
        file.writestr("a/", "")
        file.writestr("a/b.txt", "Watch TV\n\n\n\n[Walk] <couch> (1)\n")
        file.writestr("a/", "")
    assert len(scanned(tmp_path / "folders.zip")) == 1
