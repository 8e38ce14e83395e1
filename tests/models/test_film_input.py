"""Films as users have them: videos at the rate and size of clips, arrays, folders, and files that are refused."""

from __future__ import annotations

import numpy as np
import pytest

from hearth.models.films.film_files import film_file, is_film
from hearth.models.films.film_input import read_masks, read_pictures
from hearth.rendering.film.clips import RATE, SIZE
from hearth.rendering.film.video_file import Writer
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


@pytest.fixture
def video(tmp_path):
    """Four seconds that turn from dark to red."""
    pytest.importorskip("cv2")
    writer = Writer(tmp_path / "auto.webm", 64, 48, 15.0)
    for number in range(60):
        writer.add(np.full((48, 64, 3), (4 * number, 10, 10), np.uint8))
    writer.close()
    return tmp_path / "auto.webm"


def test_a_video_is_read_at_the_rate_and_size_of_clips(video):
    found = read_pictures(video)
    assert found.shape == (4 * RATE, SIZE[1], SIZE[0], 3)
    red = found[:, :, :, 0].mean((1, 2))
    assert (np.diff(red) > 5).all() and found[-1, :, :, 2].mean() < 60


def test_a_folder_stands_for_its_film(video, tmp_path):
    assert film_file(tmp_path) == video == film_file(video)
    np.savez_compressed(tmp_path / "clips.npz", class_ids=np.ones((9, 4, 4), np.uint16))
    assert film_file(tmp_path).name == "clips.npz"
    assert read_masks(film_file(tmp_path)).shape == (9, 4, 4)


def test_what_names_a_film(tmp_path):
    assert is_film("a.webm") and is_film("b/c.npz") and not is_film(str(tmp_path))
    (tmp_path / "a.mp4").write_bytes(b"text")
    assert is_film(str(tmp_path))
    assert not any(map(is_film, ("", ".", "Turn on the TV", "sit " * 4_000, "sit\0down")))


def test_files_that_are_refused(tmp_path):
    pytest.importorskip("cv2")
    with pytest.raises(HearthError) as found:
        film_file(tmp_path)
    assert found.value.diagnostics[0].code == Code.MISSING_FILE
    (tmp_path / "a.mp4").write_bytes(b"text")
    with pytest.raises(HearthError) as found:
        read_pictures(tmp_path / "a.mp4")
    assert found.value.diagnostics[0].code == Code.DAMAGED_FILE


@pytest.mark.parametrize("suffix", [".webm", ".mp4"])
@pytest.mark.parametrize("text", ["ffconcat version 1.0\nfile auto.webm\n", "#EXTM3U\n#EXTINF:9,\nauto.webm\n", ""])
def test_a_list_of_films_is_no_film(video, tmp_path, text, suffix):
    given = tmp_path / f"given{suffix}"
    given.write_text(text)
    with pytest.raises(HearthError) as found:
        read_pictures(given)
    assert found.value.diagnostics[0].code == Code.DAMAGED_FILE


@pytest.mark.parametrize("changed", [{"MOST_PIXELS": 64 * 48 - 1}, {"MOST_RATE": 14}])
def test_pictures_that_are_too_large_or_too_many_are_refused(video, monkeypatch, changed):
    from hearth.models.films import film_input

    for name, value in changed.items():
        monkeypatch.setattr(film_input, name, value)
    with pytest.raises(HearthError) as found:
        read_pictures(video)
    assert found.value.diagnostics[0].code == Code.FILE_TOO_LARGE


def test_a_pipe_is_not_waited_for(tmp_path):
    import os

    os.mkfifo(tmp_path / "film.webm")
    with pytest.raises(HearthError) as found:
        read_pictures(tmp_path / "film.webm")
    assert found.value.diagnostics[0].code == Code.UNSUPPORTED_FILE


@pytest.mark.parametrize(("rate", "pictures"), [(2.0, 40), (15.0, 300), (4.5, 90)])
def test_a_film_is_as_long_as_it_was_at_any_rate(monkeypatch, rate, pictures):
    """Slow films show the same picture again."""
    cv2 = pytest.importorskip("cv2")
    from hearth.models.films.film_input import _retrieved

    class Video:
        left = pictures

        def get(self, what):
            return rate if what == cv2.CAP_PROP_FPS else 10

        def grab(self):
            self.left -= 1
            return self.left >= 0

        def retrieve(self):
            return True, self.left

    found = list(_retrieved(Video(), None))
    assert len(found) == pytest.approx(20 * RATE, abs=RATE / rate) and found == sorted(found, reverse=True)
