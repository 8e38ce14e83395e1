"""The order in which things arrive decides nothing: not that of sources, nor that of the records in one."""

from __future__ import annotations

import json
import random

import pyarrow.parquet as pq
import pytest

from hearth.pipelines.engine.source_labels import labelled


def published(one):
    return sorted(path.relative_to(one.out) for path in (one.out / "publish").rglob("*.parquet"))


def test_sources_are_taken_by_name(tmp_path):
    for name in ("b/x.txt", "a/x.txt", "c/m.txt"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).touch()
    paths = [str(tmp_path / name) for name in ("b/x.txt", "c/m.txt", "a/x.txt")]
    assert labelled(paths) == labelled(reversed(paths))
    assert [source.label for source in labelled(paths)] == ["m.txt", "x.txt", "x.txt~2"]


@pytest.mark.slow
def test_sources_in_another_order_give_the_same_bytes(made, build_folder, tmp_path):
    again = build_folder(tmp_path / "out", reversed(made.settings.sources)).run_all()
    assert published(made) == published(again) != []
    differing = [path for path in published(made) if (made.out / path).read_bytes() != (again.out / path).read_bytes()]
    assert differing == []


@pytest.mark.slow
def test_records_in_another_order_give_the_same_rows(build_folder, tmp_path):
    steps = ["[Walk] <television> (1)", "[SwitchOn] <television> (1)", "[Walk] <sofa> (1)", "[Sit] <sofa> (1)"]
    records = [{"id": f"r{n}", "title": f"Evening {n}", "steps": steps[: 2 + n % 3]} for n in range(6)]
    shuffled = random.Random(1).sample(records, len(records))
    one, other = (
        build_folder(tmp_path / name, [lines(tmp_path / f"{name}-in/a.jsonl", entries)]).run_all()
        for name, entries in (("one", records), ("other", shuffled))
    )
    tables = {path.parts[1] for path in published(one)}
    assert len(one.rows("publish/executions")) > 2
    assert [table for table in sorted(tables) if rows(one, table) != rows(other, table)] == []


def lines(file, entries):
    file.parent.mkdir()
    file.write_text("".join(json.dumps(entry) + "\n" for entry in entries))
    return file


def rows(one, table):
    """The rows of a published table but for the line of a file that a record stood in."""
    found = pq.read_table(one.out / "publish" / table).to_pylist()
    if table == "programs":
        found = [
            row | {"place": row["place"].rpartition(":")[0], "steps": [step | {"line": 0} for step in row["steps"]]}
            for row in found
        ]
    return sorted(json.dumps(row, sort_keys=True, default=str) for row in found)
