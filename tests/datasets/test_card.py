"""The dataset card and its Croissant description, read by the tools they are for."""

from __future__ import annotations

import orjson
import pytest
import yaml

import hearth
from hearth.schemas.tables import TABLES
from hearth.storage.files import file_digest


@pytest.fixture(scope="module")
def folder(made):
    return made.out / "publish"


@pytest.fixture(scope="module")
def programs(folder):
    return list(hearth.load(folder))


def test_the_card_names_every_table_and_column(folder):
    text = (folder / "README.md").read_text()
    header = yaml.safe_load(text.split("---")[1])
    assert {config["config_name"] for config in header["configs"]} == set(TABLES)
    for table, schema in TABLES.items():
        section = text.split(f"\n### {table} (")[1].split("\n##")[0]
        assert all(f"| `{name}` |" in section for name in schema.names)
    assert "(random split:" in text


def test_the_card_s_funnel_is_the_ledger_s(folder):
    rows = hearth.load(folder).rows("SELECT stage, records_in, records_through, records_rejected FROM ledger")[1]
    text = (folder / "README.md").read_text()
    for stage, came, went, refused in rows:
        assert f"| {stage} | {came:,} | {went:,} | {refused:,} |" in text


def test_croissant_has_the_hash_of_every_part(folder):
    described = orjson.loads((folder / "croissant.json").read_bytes())
    files = [each for each in described["distribution"] if each["@type"] == "cr:FileObject"]
    assert {each["contentUrl"] for each in files} == {
        path.relative_to(folder).as_posix() for path in folder.glob("*/part-*.parquet")
    }
    assert all(file_digest(folder / each["contentUrl"]) == each["sha256"] for each in files)
    assert [each["name"] for each in described["recordSet"]] == list(TABLES)


@pytest.mark.slow
def test_mlcroissant_validates_and_loads_it(folder, programs):
    croissant = pytest.importorskip(
        "mlcroissant", reason="mlcroissant is not installed: pip install mlcroissant[parquet]"
    )
    dataset = croissant.Dataset(folder / "croissant.json")
    assert not dataset.metadata.ctx.issues.errors
    found = {row["programs/program_id"].decode() for row in dataset.records("programs")}
    assert found == set(programs)
    assert sum(1 for _ in dataset.records("ledger")) == 6


@pytest.mark.slow
def test_datasets_loads_the_folder(folder, programs, tmp_path):
    datasets = pytest.importorskip("datasets", reason="datasets is not installed: pip install datasets")
    loaded = datasets.load_dataset(str(folder), "programs", cache_dir=str(tmp_path))
    assert set(loaded["train"]["program_id"]) == set(programs)
    assert loaded["train"][0]["steps"][0]["action"]
