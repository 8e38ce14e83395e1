"""Names of data as names of files."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hearth.schemas.diagnostics import HearthError
from hearth.storage.names import file_name, inside, leaves

BAD = [
    "",
    ".",
    "..",
    "/",
    "./",
    "../x",
    "a/../../x",
    "/x",
    "\\x\\..\\..\\y",
    "c:\\x",
    "c:x",
    "a\0b",
    "x/../..",
    "n" * 5000,
    "\ud800",
]


@pytest.mark.parametrize("name", BAD)
def test_what_is_not_the_name_of_a_file_in_a_folder(tmp_path, name):
    with pytest.raises(HearthError):
        inside(tmp_path / "folder", name)


def test_links_on_the_way_are_followed_before_it_is_judged(tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "out").symlink_to(tmp_path)
    (folder / "self").symlink_to(folder / "self")
    (folder / "in").symlink_to(folder)
    for name in ("out", "out/x", "self/x"):
        with pytest.raises(HearthError):
            inside(folder, name)
    assert inside(folder, "in/x") == folder / "in/x"
    assert inside(folder, "a/b..c") == folder / "a/b..c"


@given(st.text())
def test_a_file_name_is_one_name_in_one_folder(text):
    name = file_name(text)
    assert 0 < len(name) <= 200 and "/" not in name and "\\" not in name and name.strip(".") and name.isascii()
    assert not leaves(name)


def test_file_names_stay_readable_and_different():
    assert file_name("crowd:a/../b") == "crowd%3aa%2f..%2fb"
    assert file_name("maple") == "maple"
    assert len({file_name(text) for text in ("n" * 300, "n" * 301, "..", "%2e%2e", ".", "")}) == 6
