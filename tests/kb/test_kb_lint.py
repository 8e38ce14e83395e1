"""Contradictions are found, and ours has none."""

from __future__ import annotations

import pytest

from hearth.kb.consistency import CHECKS, lint
from hearth.kb.loading.load import load

HEADER = "id,name,category,hypernym,properties,states,rooms,size,gloss,same_as,source\n"
PLACES = "object,relation,destination,room,weight,evidence\n"

WRONG = {
    "incomplete": ("objects_things.csv", HEADER + "9000,ghost,,device,,,attic,,,,mine\n"),
    "state": ("objects_things.csv", HEADER + "9000,stone,Props,device,,door,,1 1 1,a stone,,mine\n"),
    "carried": ("objects_things.csv", HEADER + "9000,wardrobe_2,Furniture,storage,GRABBABLE,,,1.2 2.2 0.6,big,,mine\n"),
    "size": ("placements.csv", PLACES + "dresser,IN,cup,,1,mine\n"),
    "carries": ("placements.csv", PLACES + "cup,ON,pillow,,1,mine\n"),
    "placeless": ("objects_things.csv", HEADER + "9000,orphan,Props,device,,,,1 1 1,alone,,mine\n"),
    "room": ("placements.csv", PLACES + "cup,ON,toilet,kitchen,1,mine\n"),
    "synonym": ("stand_ins.csv", "class,rank,stand_in,source\ncouch,1,settee,mine\n"),
    "words": ("actions_written.yaml", "Leap: {id: 900, roles: [], needs: [], words: [hop]}\n"),
    "class": ("affordances.yaml", "Cut: [{classes: [unobtainium]}]\n"),
    "usable": ("affordances.yaml", "Cut: [{contains: [zzz]}]\n"),
}


def test_ours_has_no_contradictions(knowledge):
    assert lint(knowledge) == ()


@pytest.mark.parametrize("check", CHECKS)
def test_each_check_finds_what_it_is_for(tmp_path, check):
    file, text = WRONG[check]
    (tmp_path / file).write_text(text)
    found = lint(load(overlay=tmp_path))
    assert check in {finding.check for finding in found}


def test_a_wardrobe_in_a_cup_is_said_in_words(tmp_path):
    (tmp_path / "placements.csv").write_text(PLACES + "dresser,IN,cup,,1,mine\n")
    assert [f"{f.subject} {f.message}" for f in lint(load(overlay=tmp_path))] == [
        "dresser is placed in cup, which is too small for it"
    ]
