"""The views `originals` and `execution_kinds` agree with the output of the stages."""

from __future__ import annotations

import tarfile

import pytest

import hearth
from hearth.datasets.dataset import OWN
from hearth.datasets.verify import verify
from hearth.storage.files import file_digest


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


def kinds(made):
    """Id of an execution -> its kind, by the stage that wrote it."""
    originals = {row["execution_id"]: "original" for row in made.rows("sample")}
    augmented = {row["execution_id"]: "repaired" if row["parent_id"] else "perturbed" for row in made.rows("augment")}
    return {**augmented, **originals}


def test_every_execution_has_the_kind_that_its_stage_gave_it(ds, made):
    found = dict(ds.rows("SELECT execution_id, kind FROM execution_kinds")[1])
    stored = {name for (name,) in ds.rows("SELECT execution_id FROM executions")[1]}
    assert found == {name: kind for name, kind in kinds(made).items() if name in stored}
    assert found.keys() == stored and set(found.values()) == {"original", "perturbed", "repaired"}


def test_originals_are_what_was_sampled(ds, made):
    (row,) = ds.rows("SELECT count(*), sum(executable::int), count(failure) FROM originals")[1]
    sampled = made.rows("sample")
    run = sum(case["executable"] for case in sampled)
    assert row == (len(sampled), run, len(sampled) - run)
    query = "SELECT count(*) FROM executions JOIN programs USING (program_id) WHERE parent_id IS NULL"
    assert ds.rows(query)[1][0][0] > row[0], "the obvious join has those in perturbed environments, too"


def test_what_is_left_out_of_reports_and_the_release_is_perturbed(ds):
    left_out = ds.rows(f"SELECT execution_id FROM executions e WHERE NOT ({OWN}) ORDER BY 1")
    assert left_out == ds.rows("SELECT execution_id FROM execution_kinds WHERE kind = 'perturbed' ORDER BY 1")


def test_views_are_attributes(ds):
    assert ds.originals.columns[:3] == ["execution_id", "program_id", "title"]
    assert len(ds.execution_kinds) == len(ds.executions)
    with pytest.raises(AttributeError, match=r"no table `origin`; .* and views steps, .* originals"):
        _ = ds.origin


@pytest.mark.parametrize(("version", "counts"), [("0.1", (3, 2)), ("0.2", (3, 6))])
def test_datasets_of_before_have_them_too_and_verify_as_they_did(inputs, tmp_path, version, counts):
    with tarfile.open(inputs.parents[1] / f"datasets/{version}.tar.xz") as archive:
        archive.extractall(tmp_path, filter="data")
    folder = tmp_path / f"dataset-{version}"
    before = file_digest(folder / "catalog.duckdb")
    found = dict(hearth.load(folder).rows("SELECT kind, count(*) FROM execution_kinds GROUP BY 1")[1])
    assert (found["original"], found["repaired"]) == counts
    assert hearth.load(folder).rows("SELECT count(*) FROM originals")[1] == [(3,)]
    assert verify(folder).faults == () and file_digest(folder / "catalog.duckdb") == before
