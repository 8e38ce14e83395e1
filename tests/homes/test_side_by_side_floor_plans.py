"""Floor plans side by side: a legend for each way, names that stand apart."""

from __future__ import annotations

import itertools

import pytest

from hearth.homes.floor_plan_drawing import Trail
from hearth.homes.geometry import Rect
from hearth.homes.library import load_layout, names
from hearth.homes.side_by_side_floor_plans import Panel, labelled, svg, write
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError

WAY = Trail(((1.0, 1.0), (2.0, 2.0)), "#d1495b", ((2.0, 2.0),))
PANELS = [Panel("alone", (WAY,), ("main <agent>",)), Panel("with hp", (WAY, WAY), ("main", "helper"))]


@pytest.mark.parametrize("home", names())
def test_no_two_names_overlap(home):
    layout = load_layout(home, default())
    named = {"fridge", "dishwasher", "table", "dining_table", "coffee_table", "couch"}
    texts = [shape for shape in labelled(layout, named) if shape.kind == "text"]
    assert {"fridge", "couch"} <= {shape.text for shape in texts}
    for one, other in itertools.combinations([shape.rect for shape in texts], 2):
        assert not _overlap(one, other)


def _overlap(one: Rect, other: Rect) -> bool:
    return one.x0 < other.x1 and other.x0 < one.x1 and one.z0 < other.z1 and other.z0 < one.z1


def test_each_drawing_has_its_title_its_ways_and_a_legend():
    layout = load_layout("maple", default())
    found = svg(layout, PANELS)
    assert found.count("<polyline") == 3 and "main &lt;agent&gt;" in found and "helper" in found
    assert "<agent>" not in found


def test_a_drawing_is_svg_or_png(tmp_path):
    layout = load_layout("maple", default())
    write(layout, tmp_path / "two.png", PANELS)
    assert (tmp_path / "two.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(HearthError, match="written as"):
        write(layout, tmp_path / "two.gif", PANELS)
