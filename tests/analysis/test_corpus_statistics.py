"""Statistics of a corpus: counted by hand on small ones, and drawn the same every time."""

from __future__ import annotations

import json

import pyarrow.parquet as pq
import pytest
from typer.testing import CliRunner

from hearth.analysis import corpus_figures
from hearth.analysis import corpus_statistics as numbers
from hearth.cli import app

TEXT = """Watch TV
I sit down. Then I watch TV!


[Walk] <television> (1)
[SwitchOn] <television> (1)
[Walk] <sofa> (1)
[Sit] <sofa> (1)

Watch TV
Switch the television on.


[Walk] <television> (1)
[SwitchOn] <television> (1)

Drink
Drink some milk.


[Walk] <milk> (1)
[Grab] <milk> (1)
[Drink] <milk> (1)
[Special] <burp>

Drink
Some milk for me.


[Walk] <milk> (1)
[Grab] <milk> (1)
"""


@pytest.fixture(scope="module")
def small(tmp_path_factory, knowledge):
    file = tmp_path_factory.mktemp("corpus") / "small.txt"
    file.write_text(TEXT)
    return numbers.gather([str(file)], knowledge)


def test_counts(small):
    assert list(numbers.funnel(small).values()) == [4, 4, 3, 0, 3]
    assert numbers.variety(small) == {"activities": 2, "actions": 4, "objects": 3, "unique steps": 6}
    assert numbers.averages(small) == (3, 2.67, 1.25, 4.5)
    actions, objects = numbers.frequencies(small)
    assert (actions["Walk"], objects["television"]) == (4, 4)
    assert numbers.together(small) == {("sofa", "television"): 1}
    assert dict(small.specials) == {"burp": 1} and small.refused == {"SPECIAL_BLOCK": 1}


def test_diversity_over_all_pairs(small):
    alike = numbers.similarities(small, workers=1)
    watch = alike.activities[0]
    assert (watch.title, watch.programs, watch.lcs, watch.normalised) == ("Watch TV", 2, 2.0, 0.5)
    assert alike.matrix.shape == (2, 2)
    (own,) = [own for title, _, own in numbers.beside_thesis(alike.activities) if title == "Watch TV"]
    assert own is watch


def test_blocks_stand_together(knowledge, tmp_path):
    programs = [("A", "bed"), ("B", "sofa"), ("C", "bed"), ("D", "sofa"), ("E", "bed"), ("F", "sofa")]
    text = "\n".join(f"{title}\nx.\n\n\n[Walk] <{name}> (1)\n[Find] <{name}> (1)\n" for title, name in programs)
    file = tmp_path / "a.txt"
    file.write_text(text)
    alike = numbers.similarities(numbers.gather([str(file)], knowledge), workers=1)
    found = "".join(alike.activities[number].title for number in alike.order)
    assert sorted([sorted(found[:3]), sorted(found[3:])]) == [list("ACE"), list("BDF")]


@pytest.mark.slow
def test_figures_and_numbers_are_the_same_every_time(small, tmp_path):
    alike = numbers.similarities(small, workers=1)
    first, second = (corpus_figures.write(small, alike, tmp_path / name) for name in "ab")
    assert {file.suffix for file in first} == {".png", ".svg", ".parquet"}
    for one, other in zip(first, second, strict=True):
        assert one.read_bytes() == other.read_bytes(), one.name
    funnel = pq.read_table(tmp_path / "a/funnel.parquet").to_pylist()
    assert funnel[0] == {"step": "descriptions", "ours": 4, "thesis": 1814}


def test_the_command(tmp_path):
    file = tmp_path / "small.txt"
    file.write_text(TEXT)
    result = CliRunner().invoke(app, ["corpus", "stats", str(file), "--json"])
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["variety"]["objects"] == 3
    assert "thesis 3.4" in CliRunner().invoke(app, ["corpus", "stats", str(file)]).stdout


@pytest.mark.slow
def test_the_release_sample(real_data, knowledge):
    found = numbers.gather([str(real_data / "activityprograms-sample.zip")], knowledge)
    assert len(found.programs) == 267 and not found.refused
