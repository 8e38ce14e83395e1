"""Figures of where things are: names of classes are anybody's, and stay texts."""

from collections import Counter
from xml.etree import ElementTree

from hearth.analysis.object_distribution import bar_chart, heat_map

EVIL = "<script>&x"


def texts(svg):
    return [each.text for each in ElementTree.fromstring(svg).iter() if each.tag.endswith("text")]


def test_names_stay_texts_in_figures():
    assert texts(heat_map({EVIL: Counter({"a&b": 2})}, "one < two")) == ["one < two", "a&b", EVIL]
    drawn = texts(bar_chart({"a & b": {EVIL: Counter({"<i>": 1})}}, [EVIL]))
    assert drawn == ["a & b", EVIL, "<i>", "100%"]
