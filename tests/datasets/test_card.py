"""The dataset card and its Croissant description, read by the tools they are for."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace

import orjson
import pytest
import yaml

import hearth
from hearth.datasets.format.splits import DESCENDED, DRAWN
from hearth.pipelines.engine.runner import run_stage
from hearth.pipelines.engine.stages import stage
from hearth.schemas.program import MOST_OBJECTS
from hearth.schemas.tables import KEYS, REFERENCES, TABLES, comment_of, nested
from hearth.storage.files import file_digest
from hearth.storage.partitions import read_rows


@pytest.fixture(scope="module")
def folder(made):
    return made.out / "publish"


@pytest.fixture(scope="module")
def parted(made, tmp_path_factory):
    """The same, with a seed by which each part of the split has programs."""
    out = shutil.copytree(made.out, tmp_path_factory.mktemp("parted") / "out")
    run_stage(stage("publish"), replace(made.settings, out=str(out), seed=3))
    return out / "publish"


def by_split(folder):
    """Split -> the ids of its programs; None for those that are in none."""
    found = {}
    for name, split in hearth.load(folder).rows("SELECT program_id, split FROM programs")[1]:
        found.setdefault(split, set()).add(name)
    return found


def configs(folder):
    header = yaml.safe_load((folder / "README.md").read_text().split("---")[1])
    return {config["config_name"]: config for config in header["configs"]}


def test_files_of_a_split_have_the_programs_of_that_split(parted):
    found, expected = configs(parted), by_split(parted)
    assert set(expected) >= {"train", "validation", "test"}
    assert [name for name, config in found.items() if config.get("default")] == ["programs"]
    files = {each["split"]: each["path"] for each in found["programs"]["data_files"]}
    assert set(files) == {"train", "validation", "test"}
    for split, pattern in files.items():
        rows = [row for path in parted.glob(pattern) for row in read_rows(path, ["program_id", "split"])]
        assert {row["program_id"] for row in rows} == expected[split] and {row["split"] for row in rows} == {split}
    assert ("programs_left_out" in found) == (None in expected)


def test_tables_that_descend_from_programs_have_their_parts_and_the_others_rows(parted):
    found = configs(parted)
    assert {name for name in found if name != "programs_left_out"} == {
        table for table in TABLES if hearth.load(parted).rows(f"SELECT count(*) FROM {table}")[1] != [(0,)]
    }
    splits = {name: [each["split"] for each in found[name]["data_files"]] for name in found if name != "programs"}
    assert splits["executions"] == splits["environments"] == ["train", "validation", "test", "rows"]
    assert all(names[-1] == "rows" for names in splits.values())
    assert {name for name, names in splits.items() if names != ["rows"]} <= {*DESCENDED}


def test_rows_are_in_the_part_of_the_program_that_they_descend_from(parted):
    part_of = dict(hearth.load(parted).rows("SELECT program_id, split FROM programs")[1])
    seen = 0
    for table in sorted({*DESCENDED} - {*DRAWN}):
        for path in sorted((parted / table).glob("*.parquet")):
            share = path.name.split(".")[1]
            for row in read_rows(path):
                program_id = row["program_id"] or row["parent_id"]
                assert (part_of[program_id] or "left_out") == share, (table, program_id)
                seen += 1
    assert seen > 100


def test_the_card_names_every_table_and_column(folder):
    text = (folder / "README.md").read_text()
    for table, schema in TABLES.items():
        section = text.split(f"\n### {table} (")[1].split("\n##")[0]
        assert comment_of(schema) in section
        assert all(f"| `{path}` |" in section for column in schema for path, _ in nested(column))
    assert "(random split:" in text


def test_the_card_s_funnel_is_the_ledger_s(folder):
    rows = hearth.load(folder).rows("SELECT stage, records_in, records_through, records_rejected FROM ledger")[1]
    text = (folder / "README.md").read_text()
    for name, came, went, refused in rows:
        assert f"| {name} | {came:,} | {went:,} | {refused:,} |" in text


def test_croissant_has_the_hash_of_every_part(folder):
    described = orjson.loads((folder / "croissant.json").read_bytes())
    files = [each for each in described["distribution"] if each["@type"] == "cr:FileObject"]
    assert {each["contentUrl"] for each in files} == {
        path.relative_to(folder).as_posix() for path in folder.glob("*/part-*.parquet")
    }
    assert all(file_digest(folder / each["contentUrl"]) == each["sha256"] for each in files)
    assert [each["name"] for each in described["recordSet"]] == list(TABLES)


def described(fields):
    """Id -> field, of fields and those within them."""
    return {each["@id"]: each for field in fields for each in (field, *described(field.get("subField", ())).values())}


def test_croissant_describes_every_column_within_columns_keys_and_references(folder):
    sets = {each["@id"]: each for each in orjson.loads((folder / "croissant.json").read_bytes())["recordSet"]}
    for table, schema in TABLES.items():
        fields = described(sets[table]["field"])
        every = {
            f"{table}/{path.replace('[]', '').replace('.', '/')}": at
            for column in schema
            for path, at in nested(column)
        }
        # Objects within a list are a field for each place.
        places = {name: field for name, field in fields.items() if re.search(r"/objects/[01](/|$)", name)}
        columns = {re.sub(r"/objects/[01]/", "/objects/", name): field for name, field in fields.items()}
        columns = {name: field for name, field in columns.items() if name not in places}
        assert {name: field["description"] for name, field in columns.items()} == {
            name: comment_of(at) for name, at in every.items()
        }
        assert all(name.replace("/0", "/1", 1) in places for name in places)
        assert all(("dataType" in field) != ("subField" in field) for field in fields.values())
        keys = {each["@id"] for each in sets[table]["key"]}
        assert keys <= set(fields) and keys == {f"{table}/{column}" for column in KEYS[table] if column != "keep"}
        found = {
            (table, name.split("/")[1], field["references"]["fileSet"]["@id"], field["references"]["extract"]["column"])
            for name, field in fields.items()
            if "references" in field
        }
        assert found == {(of, column, f"{other}-files", key) for of, column, other, key in REFERENCES if of == table}


@pytest.mark.tools
def test_mlcroissant_validates_it_and_reads_programs_with_their_steps(parted):
    croissant = pytest.importorskip("mlcroissant", reason="mlcroissant is not installed")
    dataset, ds = croissant.Dataset(parted / "croissant.json"), hearth.load(parted)
    assert not dataset.metadata.ctx.issues.errors and not dataset.metadata.ctx.issues.warnings
    found = {row["programs/program_id"].decode(): row for row in dataset.records("programs")}
    assert set(found) == set(ds)
    for name, row in found.items():
        steps = ds[name].row["steps"]
        assert [step["programs/steps/action"].decode() for step in row["programs/steps"]] == [
            step["action"] for step in steps
        ]
        for place in range(MOST_OBJECTS):
            at = f"programs/steps/objects/{place}"
            assert [(each[f"{at}/name"] or b"").decode() for each in row[at]] == [
                "".join(ref["name"] for ref in step["objects"][place : place + 1]) for step in steps
            ]
    for table in [name for name in TABLES if name != "programs"]:  # it reads nothing a second time
        assert [(sum(1 for _ in dataset.records(table)),)] == ds.rows(f"SELECT count(*) FROM {table}")[1], table


@pytest.mark.tools
def test_load_dataset_gives_the_splits_as_splits(parted, tmp_path):
    library = pytest.importorskip("datasets.load", reason="the library `datasets` is not installed")
    loaded = library.load_dataset(str(parted), cache_dir=str(tmp_path))
    expected = {split: ids for split, ids in by_split(parted).items() if split}
    assert {split: set(rows["program_id"]) for split, rows in loaded.items()} == expected
    assert loaded["train"][0]["steps"][0]["action"]
    for name, config in configs(parted).items():
        found = library.load_dataset(str(parted), name, cache_dir=str(tmp_path))
        assert [*found] == [each["split"] for each in config["data_files"]]
        if name in TABLES and name != "programs":
            assert [(found["rows"].num_rows,)] == hearth.load(parted).rows(f"SELECT count(*) FROM {name}")[1]


@pytest.mark.tools
def test_executions_have_the_splits_of_their_programs(parted, tmp_path):
    library = pytest.importorskip("datasets.load", reason="the library `datasets` is not installed")
    loaded = library.load_dataset(str(parted), "executions", cache_dir=str(tmp_path))
    programs = by_split(parted)
    for part in ("train", "validation", "test"):
        assert {*loaded[part]["program_id"]} <= programs[part]
    assert {*loaded["rows"]["program_id"]} == set.union(*programs.values())
