"""Scanning packed files ends after a time that depends on their size, with a reject; honest ones are read whole."""

from __future__ import annotations

import gzip
import time
import zipfile

import pytest

from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items
from hearth.pipelines.readers import scanning_time
from hearth.schemas.failures import Code

MANY = b"".join(b'{"a":%d}\n' % number for number in range(60_000))
FEW = b'{"a":1}\n' * 20


def scanned(path, seconds):
    return [item for _, item in items(labelled([str(path)]), time_limit=seconds)]


def out_of_time(item):
    return item.reader == "refused" and item.value[0][0] == Code.TIMED_OUT


@pytest.fixture
def packed(tmp_path):
    path = tmp_path / "a.jsonl.gz"
    path.write_bytes(gzip.compress(MANY))
    return path


def test_a_packed_file_has_its_time(packed):
    found = scanned(packed, 0.5)
    assert out_of_time(found[-1]) and not any(map(out_of_time, found[:-1]))
    assert "--time-limit" in str(found[-1].value)
    assert len(found) < 60_001 == len(scanned(packed, 0)) + 1


def test_what_is_not_packed_has_no_limit(tmp_path):
    path = tmp_path / "a.jsonl"
    path.write_bytes(MANY)
    assert len(scanned(path, 0.01)) == 60_000


def test_members_share_the_time_of_their_archive(tmp_path):
    path = tmp_path / "a.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in ("a.jsonl", "b.jsonl", "c.jsonl"):
            archive.writestr(name, MANY)
    found = scanned(path, 0.5)
    assert [item.place.rsplit("/", 1)[-1] for item in found if out_of_time(item)] == ["a.jsonl", "b.jsonl", "c.jsonl"]
    assert len(found) < 60_000


def test_one_search_that_takes_long_is_interrupted(tmp_path):
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(b"title,program\n" + b"\n" * 2_000_000))
    began = time.process_time()
    (*_, last) = scanned(path, 0.6)
    assert out_of_time(last) and time.process_time() - began < 10


def test_the_time_of_those_who_use_the_items_is_not_counted(tmp_path):
    path = tmp_path / "a.jsonl.gz"
    path.write_bytes(gzip.compress(FEW))
    found = []
    for _, item in items(labelled([str(path)]), time_limit=3.0):
        found.append(item)
        until = time.process_time() + 0.1
        while time.process_time() < until:
            pass
    assert len(found) == 20 and not any(map(out_of_time, found))


def test_a_larger_file_has_more_time(packed, monkeypatch):
    monkeypatch.setattr(scanning_time, "_OF_A_MEGABYTE", 1e6)
    assert len(scanned(packed, 0.5)) == 60_000


def test_it_is_tried_again_with_more_time(built, packed):
    assert built(packed, time_limit=0.3).run("ingest").manifest.counts.codes[Code.TIMED_OUT] == 1
    assert built(packed, time_limit=0).run("ingest").manifest.counts.codes[Code.TIMED_OUT] == 0
