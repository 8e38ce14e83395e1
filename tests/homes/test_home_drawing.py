"""Floor plans as SVG and PNG."""

import xml.etree.ElementTree as Xml
from dataclasses import replace

import pytest

from hearth.homes import floor_plan_drawing, library
from hearth.homes.geometry import footprint
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError


def test_the_svg_shows_every_room_and_piece_of_furniture(tmp_path):
    layout = library.load_layout("maple", default())
    floor_plan_drawing.write(layout, tmp_path / "plan.svg")
    root = Xml.parse(tmp_path / "plan.svg").getroot()
    texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
    assert {room.name for room in layout.plan.rooms} <= set(texts)
    standing = [thing.class_name for thing in layout.things if thing.mount == "floor"]
    assert sorted(text for text in texts if text in set(standing)) == sorted(standing)
    # North is up: what lies further north is drawn higher.
    heights = {e.text: float(e.get("y")) for e in root.iter("{http://www.w3.org/2000/svg}text")}
    assert heights["kitchen"] < heights["living_room"]


def test_everything_drawn_lies_within_the_drawing():
    layout = library.load_layout("willow", default())
    area = floor_plan_drawing.bounds(layout)
    assert all(area.contains(shape.rect) for shape in floor_plan_drawing.shapes(layout))


def test_the_png_is_the_same_each_time(tmp_path):
    layout = library.load_layout("maple", default())
    for name in ("one.png", "two.png"):
        floor_plan_drawing.write(layout, tmp_path / name)
    assert (tmp_path / "one.png").read_bytes() == (tmp_path / "two.png").read_bytes()
    assert (tmp_path / "one.png").read_bytes().startswith(b"\x89PNG")


def test_other_formats_are_refused(tmp_path):
    with pytest.raises(HearthError, match="UNSUPPORTED_FILE"):
        floor_plan_drawing.write(library.load_layout("maple", default()), tmp_path / "plan.gif")


def test_names_of_furniture_are_written_over_what_stands_on_it():
    drawn = list(floor_plan_drawing.shapes(library.load_layout("maple", default())))
    last = max(number for number, shape in enumerate(drawn) if shape.kind == "rect")
    assert all(number > last for number, shape in enumerate(drawn) if shape.kind == "text")
    assert {"character", "bed", "fridge"} <= {shape.text for shape in drawn if shape.kind == "text" and shape.edge}


@pytest.mark.parametrize("name", library.names())
def test_the_name_of_a_room_lies_on_its_floor(name):
    layout = library.load_layout(name, default())
    names = [shape for shape in floor_plan_drawing.shapes(layout) if shape.kind == "text" and not shape.edge]
    assert [shape.text for shape in names] == [room.name for room in layout.plan.rooms]
    standing = [
        footprint(thing.box) for thing in layout.things if thing.mount == "floor" and thing.class_name != "wall"
    ]
    for shape, room in zip(names, layout.plan.rooms, strict=True):
        assert room.rect.contains(shape.rect)
        assert sum(shape.rect.overlap(each) for each in standing) < 0.1 * shape.rect.width * shape.rect.depth


def test_blinds_are_drawn_as_curtains():
    layout = library.load_layout("maple", default())
    curtain = next(thing for thing in layout.things if thing.class_name == "curtain")
    hung = replace(layout, things=(*layout.things, replace(curtain, class_name="blinds")))
    colour = floor_plan_drawing.COLOURS["curtain"]
    drawn, before = (sum(shape.fill == colour for shape in floor_plan_drawing.shapes(each)) for each in (hung, layout))
    assert drawn == before + 1
