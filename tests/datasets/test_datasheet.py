"""A dataset's authors are the same in card, Croissant, report and README; the thesis is cited as the library has it."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import orjson
import pytest
import yaml
from hostile_datasets import rewrite

import hearth
from hearth.datasets.format.card import write_card
from hearth.datasets.format.croissant import write_croissant
from hearth.datasets.format.datasheet import datasheet
from hearth.datasets.report.report_writer import write_report

ROOT = Path(__file__).resolve().parents[2]
SHEET = yaml.safe_load((ROOT / "datasets/format/datasheet.yaml").read_text())
WRITTEN, CROWD = SHEET["origins"]["written"], SHEET["origins"]["crowd"]


def one_line(text):
    return " ".join(text.replace("`", "").replace("*", "").split())


@pytest.fixture(scope="module")
def written(made, tmp_path_factory):
    """The dataset of the golden input as if all of its crowd had been authors."""
    folder = shutil.copytree(made.out / "publish", tmp_path_factory.mktemp("written") / "dataset")
    for table in ("programs", "descriptions"):
        rewrite(folder, table, lambda row: {**row, "origin": "written" if row["origin"] == "crowd" else row["origin"]})
    write_card(folder)
    write_croissant(folder)
    return folder


def said(folder, tmp_path):
    """Return the texts of card, Croissant and report."""
    write_report(hearth.load(folder), tmp_path / "report")
    described = orjson.loads((folder / "croissant.json").read_bytes())
    report = re.sub(r"&#39;", "'", (tmp_path / "report/index.html").read_text())
    return [
        (folder / "README.md").read_text(),
        described["rai:dataCollection"],
        described["rai:dataLimitations"],
        report,
    ]


def test_what_was_written_is_not_called_a_crowd_s(written, tmp_path):
    for text in map(one_line, said(written, tmp_path)):
        assert one_line(WRITTEN) in text
        assert one_line(CROWD) not in text


def test_what_a_crowd_answered_is_not_called_written(made, tmp_path):
    for text in map(one_line, said(made.out / "publish", tmp_path)):
        assert one_line(CROWD) in text and one_line(SHEET["origins"]["augmented"]) in text
        assert one_line(WRITTEN) not in text


def test_the_embedded_corpus_was_written_before_it_said_so(made, tmp_path):
    folder = shutil.copytree(made.out / "publish", tmp_path / "dataset")
    for table, key in (("programs", "program_id"), ("descriptions", "description_id")):
        rewrite(
            folder, table, lambda row, key=key: {**row, key: re.sub("^crowd:(.)", r"crowd:3\g<1>0001A2SM", row[key])}
        )
    authors = datasheet(folder)["authors"]
    assert WRITTEN in authors and CROWD not in authors


@pytest.mark.parametrize("name", ["motivation", "composition", "process", "uses", "limits", "thesis", "bibtex"])
def test_the_card_has_the_questions_of_a_datasheet(written, name):
    assert SHEET[name] in (written / "README.md").read_text()


def test_the_readme_says_who_wrote_the_corpus_and_names_the_thesis():
    text = (ROOT / "README.md").read_text()
    assert one_line(WRITTEN) in one_line(text)
    assert SHEET["bibtex"] in text and one_line(SHEET["thesis"]) in one_line(text)


def test_the_citation_file_has_the_same_thesis():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert {"cff-version", "message", "title", "authors"} <= cited.keys()
    (thesis,) = cited["references"]
    (author,) = thesis["authors"]
    bibtex = SHEET["bibtex"].replace("{\\'a}", "á").replace("{VirtualHome}", "VirtualHome")
    assert f"author = {{{author['family-names']}, {author['given-names']}}}" in bibtex
    assert f"title = {{{thesis['title']}}}" in bibtex
    assert f"year = {{{thesis['year']}}}" in bibtex and f"url = {{{thesis['url']}}}" in bibtex
    assert thesis["month"] == 2 and "month = feb" in bibtex
    assert thesis["institution"]["name"] in bibtex and thesis["department"] in bibtex
