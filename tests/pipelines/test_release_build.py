"""The release sample through the pipeline (skipped, saying so, where it is not there)."""

from __future__ import annotations

import pytest

import hearth
from hearth.pipelines.build import build
from hearth.pipelines.engine.stages import STAGES

STORED = "SELECT count(*), count(*) FILTER (reproduces) FROM executions WHERE rules = 'replay'"


@pytest.fixture(scope="module")
def published(real_data, tmp_path_factory):
    out = tmp_path_factory.mktemp("release") / "out"
    return build([real_data / "activityprograms-sample.zip"], out, limit=12, pictures=0, variants=1), out


def test_every_program_is_published_and_ends_as_stored(published):
    funnel, out = published
    assert [funnel.stages[name].rejected for name in ("ingest", "validate", "sample", "publish")] == [0] * 4
    found = hearth.load(out).rows(
        "SELECT count(*), count(*) FILTER (reproduces) FROM executions WHERE rules = 'replay'"
    )
    assert found[1] == [(12, 12)]


def test_the_home_is_derived_from_the_start_graphs(published):
    _, out = published
    ((home, origin, nodes, edges),) = hearth.load(out).rows("SELECT home, origin, nodes, edges FROM homes")[1]
    assert (home, origin) == ("TrimmedTestScene1", "derived")
    assert 270 <= nodes <= 290
    assert edges > 5_000


def test_programs_join_to_repairs_and_to_final_states(published):
    _, out = published
    ds = hearth.load(out)
    query = """
        SELECT p.program_id, r.handler, e.execution_id FROM programs p
        JOIN repairs r USING (program_id) JOIN executions e USING (execution_id) LIMIT 1
    """
    ((_, handler, execution_id),) = ds.rows(query)[1]
    assert handler
    assert ds.rows("SELECT count(*) FROM final_state($id)", id=execution_id)[1][0][0] > 100


@pytest.mark.slow
def test_the_whole_sample(real_data, tmp_path):
    funnel = build([real_data / "activityprograms-sample.zip"], tmp_path / "out", workers=2, pictures=0)
    assert list(funnel.stages) == list(STAGES)
    assert hearth.load(tmp_path / "out").rows(STORED)[1] == [(267, 267)]
