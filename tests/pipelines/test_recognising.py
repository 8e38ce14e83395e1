"""The reader that each source gets, and the message for sources that no reader takes."""

from __future__ import annotations

import zipfile

import pytest
from read_sources import PROGRAM, answer, batch, faults, read, rows, zipped

from hearth.pipelines.readers.recognition_by_content import recognise
from hearth.schemas.diagnostics import HearthError
from hearth.storage.files import SERVED


def test_an_archive_without_the_releases_folders(tmp_path):
    path = tmp_path / "other.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("photos/cat.jpg", b"")
    with pytest.raises(HearthError, match=r"without any of the release's folders.*photos/cat\.jpg"):
        read(path)


def test_a_folder_of_a_server_without_accepted_programs(tmp_path):
    (tmp_path / SERVED).mkdir()
    with pytest.raises(HearthError, match=r"nothing was accepted yet \(review programs"):
        list(recognise(tmp_path, "collected"))


def test_a_folder_of_pictures(write):
    write("pictures/a.png", b"\x89PNG\r\n\x1a\n")
    folder = write("pictures/b.jpg", b"\xff\xd8\xff\xe0").parent
    with pytest.raises(HearthError, match="nothing to read among 2 files; the first is a PNG picture"):
        read(folder)


def test_a_picture_among_programs_is_a_reject(write):
    write("mix/a.png", b"\x89PNG\r\n\x1a\n")
    folder = write("mix/b.txt", PROGRAM).parent
    found = read(folder)
    assert len(rows(found)) == 1
    assert faults(found) == [("UNSUPPORTED_FILE", "mix/a.png", 0)]


def test_names_do_not_matter(write, release, tmp_path):
    path = zipped(release, write("release.txt", b""))
    assert next(recognise(path, "x")).reader == "release"
    assert next(recognise(write("batch.txt", batch(answer(1))), "x")).reader == "crowd"
    assert next(recognise(write("program.csv.old", PROGRAM), "x")).reader == "text"


def test_sources_that_share_a_name_are_distinguished(write):
    found = read(write("one/tv.txt", PROGRAM), write("two/tv.txt", PROGRAM))
    assert [row["program_id"] for row in rows(found)] == ["text:tv.txt", "text:tv.txt~2"]


def test_missing_sources_are_all_named(tmp_path):
    with pytest.raises(HearthError, match=r"one.*\n.*two"):
        read(tmp_path / "one", tmp_path / "two")


def test_a_link_that_leaves_the_folder_is_not_followed(write, tmp_path):
    secret = tmp_path / "secret.txt"
    secret.write_text(PROGRAM)
    folder = write("p/a.txt", PROGRAM).parent
    (folder / "b.txt").symlink_to(secret)
    assert [row["program_id"] for row in rows(read(folder))] == ["text:p/a.txt"]


def test_a_limit_counts_programs(write, built):
    write("a.csv", batch(*(answer(number, worker=f"W{number}") for number in range(5))))
    folder = write("z.txt", "\n".join([PROGRAM] * 4)).parent
    limited = built(folder, limit=3)
    limited.run("ingest")
    assert [row["kind"] for row in limited.rows("ingest")] == ["description"] * 3 + ["program"] * 3
