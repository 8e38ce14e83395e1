"""Arrays of films: what is stored is read, and what strangers store instead is refused before anything is allocated."""

from __future__ import annotations

import struct
import tracemalloc
import zipfile
from io import BytesIO
from types import SimpleNamespace

import numpy as np
import pytest

from hearth.models.demonstrations.demonstration_data import MOST_PICTURES, Demonstrations, arrays
from hearth.models.films.clip_data import Clips
from hearth.models.films.film_arrays import CHANGES, MASKS, film_array
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def packed(method=zipfile.ZIP_DEFLATED, **members):
    held = BytesIO()
    with zipfile.ZipFile(held, "w", method) as archive:
        for name, data in members.items():
            archive.writestr(f"{name}.npy", data)
    return BytesIO(held.getvalue())


def member(shape, kind="'<u2'", data=b"", more="", version=b"\x01\x00"):
    text = f"{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}, }}{more}\n".encode()
    size = struct.pack("<H" if version == b"\x01\x00" else "<I", len(text))
    return b"\x93NUMPY" + version + size + text + data


def array(values):
    held = BytesIO()
    np.save(held, values)
    return held.getvalue()


def refused(data, most=None):
    with pytest.raises(HearthError) as found:
        film_array(data, "x.npz", MASKS, *([] if most is None else [most]))
    (fault,) = found.value.diagnostics
    assert fault.file == "x.npz" and fault.suggestion
    return fault.code


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
def test_what_numpy_stores_is_read(save):
    held, masks = BytesIO(), np.arange(24, dtype=np.uint16).reshape(2, 3, 4)
    save(held, class_ids=masks, depth=np.zeros(9))
    found = film_array(BytesIO(held.getvalue()), "x.npz")
    assert np.array_equal(found, masks) and found.flags.writeable


HUGE = ("(1000000000000, 1, 1)", "(1, 4000000, 4000000)", "(6001, 1, 1)", "(5000, 512, 512)")


@pytest.mark.parametrize("shape", HUGE)
def test_no_room_is_made_for_what_a_header_says(shape):
    tracemalloc.start()
    assert refused(packed(class_ids=member(shape, data=bytes(24)))) == Code.FILE_TOO_LARGE
    assert tracemalloc.get_traced_memory()[1] < 1 << 22
    tracemalloc.stop()


WRONG = (
    member("(3, 2, 2)", "'|O'", bytes(96)), member("(3, 2, 2)", "[('a', '|O')]", bytes(96)),
    member("(3, 2)", data=bytes(12)), member("(0, 2, 2)"), member("(-3, -2, 2)", data=bytes(24)),
    member("(3, 2, 2)", "'>u2'", bytes(24)), member("(3, 2, 2)", data=bytes(25)), member("(3, 2, 2)", data=bytes(23)),
    member("(3, 2, 2)", more=" " * 60_000), member("(" * 9_000), member("-" * 9_000 + "1"),
    member("(3, 2, 2)", data=bytes(24), version=b"\x02\x00"), b"", b"\x80\x04.", b"\x93NUMPY\x01\x00\x05\x00{'a': ",
)  # fmt: skip


@pytest.mark.parametrize("bad", WRONG, ids=range(len(WRONG)))
def test_what_is_no_array_of_a_film_is_refused(bad):
    assert refused(packed(class_ids=bad)) == Code.DAMAGED_FILE


def test_ways_of_packing_that_numpy_does_not_know_are_refused():
    good = array(np.zeros((3, 2, 2), np.uint16))
    whole = packed(class_ids=good).getvalue()
    place = whole.index(b"PK\x01\x02")
    for at, value in ((8, 1), (10, 99), (6, 255)):  # encrypted; an unknown method; an unknown version
        changed = bytearray(whole)
        changed[place + at] = value
        assert refused(BytesIO(bytes(changed))) == Code.DAMAGED_FILE
    assert refused(packed(zipfile.ZIP_LZMA, class_ids=good)) == Code.DAMAGED_FILE
    assert refused(BytesIO(b"text")) == refused(packed(depth=good)) == Code.DAMAGED_FILE


def test_a_demonstration_has_so_many_pictures_at_most():
    masks, changes = np.zeros((MOST_PICTURES + 1, 1, 1), np.uint16), np.zeros((MOST_PICTURES + 1, 1, 1, 3), np.uint8)
    data = packed(**{MASKS: array(masks), CHANGES: array(changes)}).getvalue()
    with pytest.raises(HearthError, match="2,000 pictures"):
        arrays(data, "above.npz")
    assert len(film_array(BytesIO(data), "above.npz")) == MOST_PICTURES + 1


ROW = ("one", "films/one.npz", 0, 9, "Walk", ["sofa"], "seen", 1)


@pytest.mark.parametrize("place, bad", [*((place, None) for place in range(8)), (3, 0), (3, -1), (5, [None])])
def test_rows_of_clips_without_a_value_are_refused(place, bad):
    row = (*ROW[:place], bad, *ROW[place + 1 :])
    with pytest.raises(HearthError) as found:
        Clips.of(SimpleNamespace(rows=lambda *_, **__: ([], [ROW, row])), "train")
    assert found.value.diagnostics[0].code == Code.DAMAGED_FILE


@pytest.mark.parametrize("row", [(None, "x"), ("x", None)])
def test_rows_of_demonstrations_without_a_value_are_refused(row):
    with pytest.raises(HearthError) as found:
        Demonstrations.of(SimpleNamespace(rows=lambda *_: ([], [row])))
    assert found.value.diagnostics[0].code == Code.DAMAGED_FILE


def test_pictures_show_so_many_classes_at_most():
    masks, changes = np.arange(4096, dtype=np.uint16).reshape(1, 64, 64), np.zeros((1, 64, 64, 3), np.uint8)
    with pytest.raises(HearthError, match="4,096 classes"):
        arrays(packed(**{MASKS: array(masks), CHANGES: array(changes)}).getvalue(), "above.npz")
    few = packed(**{MASKS: array(masks % 600), CHANGES: array(changes)}).getvalue()
    assert arrays(few, "above.npz").masks.max() == 599
