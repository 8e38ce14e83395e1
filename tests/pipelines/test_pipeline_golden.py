"""Each stage over the golden input, against what it is known to give.

The expected files are `tests/golden/pipelines/<stage>/*.json`. A change of knowledge or of sampling may change them:
look at the difference, then refresh them with the command that a failing test prints.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from hearth.datasets.format.row_conversion import program_of
from hearth.pipelines.engine.stages import STAGES
from hearth.schemas.syntax import print_lines

REFRESH = "HEARTH_REFRESH=1 python -m pytest tests/pipelines/test_pipeline_golden.py"


@pytest.fixture
def out(made):
    return made.out


def read(folder: Path) -> list[dict]:
    return [row for path in sorted(folder.glob("part-*.parquet")) for row in pq.ParquetFile(path).read().to_pylist()]


def graph(row):
    return row and {"nodes": len(row["nodes"]), "edges": len(row["sources"])}


def ingest(folder):
    for row in read(folder):
        for grounding in row["groundings"] or ():
            grounding["start"] = graph(grounding["start"])
        yield row


def validate(folder):
    for row in read(folder):
        row["steps"] = list(print_lines(program_of(row)))
        for grounding in row["groundings"]:
            grounding["start"] = graph(grounding["start"])
            grounding["steps"] = len(grounding["steps"])
        yield row


def sample(folder):
    for row in read(folder):
        row["steps"] = list(print_lines(program_of(row)))
        if row["origin"] != "release":
            # What was drawn at random is judged elsewhere; here it would change with every object we learn of.
            yield {name: row[name] for name in ("execution_id", "home", "seed", "steps", "executable", "rules")}
        else:
            yield row


def augment(folder):
    for row in read(folder):
        yield {
            "execution_id": row["execution_id"],
            "parent_id": row["parent_id"],
            "steps": list(print_lines(program_of(row))),
            "outcome": row["outcome"],
            "failure": row["failure"] and row["failure"]["code"],
            "perturbations": [[one["kind"], one["attempts"]] for one in row["perturbations"]],
            "repairs": [
                [one["failure"]["code"], one["handler"], one["before"], one["after"]] for one in row["repairs"]
            ],
        }


def publish(folder):
    for table in ("activities", "descriptions", "homes", "ledger"):
        yield {table: read(folder / table)}
    yield {"programs": [{name: row[name] for name in ("program_id", "split")} for row in read(folder / "programs")]}
    manifest = json.loads((folder / "manifest.json").read_text())
    yield {"files": sorted(manifest["files"])}


VIEWS = {
    "ingest": ingest,
    "validate": validate,
    "sample": sample,
    "augment": augment,
    "render": read,
    "publish": publish,
}


def rejects(folder):
    return pq.read_table(folder / "rejects.parquet").to_pylist()


def counts(folder):
    return json.loads((folder / "manifest.json").read_text())["counts"]


@pytest.mark.parametrize("stage", VIEWS)
@pytest.mark.parametrize("what", ["rows", "rejects", "counts"])
def test_stage(out, inputs, stage, what):
    view = {"rows": lambda folder: list(VIEWS[stage](folder)), "rejects": rejects, "counts": counts}[what]
    text = json.dumps(view(out / stage), indent=1, ensure_ascii=False) + "\n"
    path = inputs.parent / stage / f"{what}.json"
    if os.environ.get("HEARTH_REFRESH"):
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    assert path.exists(), f"no {path}; write it with: {REFRESH}"
    assert text == path.read_text(), f"{stage}/{what} differs; if that is meant, refresh with: {REFRESH}"


def test_the_ledger_adds_up_from_stage_to_stage(out):
    found = {stage: counts(out / stage) for stage in STAGES}
    for stage, one in found.items():
        assert one["records_in"] == one["through"] + one["rejected"], stage
        assert one["rejected"] == sum(one["codes"].values()), stage
    assert found["validate"]["records_in"] == found["ingest"]["tally"]["program"]
    assert found["sample"]["records_in"] == found["validate"]["through"]
    assert found["augment"]["records_in"] == found["sample"]["tally"]["executable"]
    assert found["publish"]["records_in"] == sum(found["sample"]["rows"].values()) + found["augment"]["rows"][""]


def test_augment_keeps_sketches_and_failed_attempts(out):
    programs = {row["program_id"]: row for row in [*read(out / "sample"), *read(out / "augment")]}
    sketches = {row["program_id"]: row for row in read(out / "publish" / "sketches")}
    augmented = read(out / "augment")
    assert set(sketches) >= {row["program_id"] for row in augmented}
    for row in sketches.values():
        assert len(row["keep"]) == len(programs[row["program_id"]]["steps"]) and sum(row["keep"]) == len(row["steps"])
        parent = programs[row["program_id"]]["parent_id"]
        assert row["origin"] == ("inherited" if parent else "inferred")
        assert not parent or set(row["steps"]) <= set(sketches[parent]["steps"])
    repairs = read(out / "publish" / "repairs")
    assert len(repairs) == sum(len(row["repairs"]) for row in augmented)
    assert {(row["environment_id"], row["outcome"]) for row in repairs} == {
        (row["environment_id"], row["outcome"]) for row in augmented if row["parent_id"] is None
    }
