"""Procedural homes: always sound, the same for the same seed, written as plans that people can edit."""

from dataclasses import replace

import pytest

from hearth.homes import library
from hearth.homes.lint import lint
from hearth.homes.plans.layout import read
from hearth.homes.plans.plan_entries import read_plan
from hearth.homes.plans.plan_writer import plan_text
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.yaml_fields import Faults

KITCHENS = {"kitchen", "dining_room", "home_office"}


@pytest.fixture(scope="module", params=[(rooms, seed) for rooms in range(3, 10) for seed in (0, 1)])
def layout(request):
    return generate(*request.param, default())


def test_generated_homes_lint_clean_and_have_what_is_needed(layout):
    graph = scene(layout, default())
    assert lint(graph, default()) == ()
    classes = {node.class_name for node in graph.nodes}
    assert {"bed", "toilet", "sink", "light", "door", "character"} <= classes
    assert len(graph.nodes) > 40 * len(layout.plan.rooms)
    if {"kitchen", "dining_room"} & {room.class_name for room in layout.plan.rooms}:
        assert {"fridge", "stove", "dishwasher"} <= classes


def test_a_generated_plan_reads_back_to_the_same_home(layout):
    # Reading applies every check of plans: walls, doors, clearances, reach.
    again = read(plan_text(layout.plan), "", default())
    assert scene(again, default()) == scene(layout, default())


def test_tables_are_laid_and_shelves_filled(layout):
    names = {thing.class_name: thing.name for thing in layout.things}
    if "bookshelf" in names:
        assert any(thing.on == names["bookshelf"] and thing.class_name == "book" for thing in layout.things)
    for table in ("table", "dining_table", "kitchen_table"):
        if table in names:
            assert any(thing.on == names[table] and thing.class_name == "plate" for thing in layout.things)


def test_the_seed_decides():
    one, same, other = generate(4, 7, default()), generate(4, 7, default()), generate(4, 8, default())
    assert one.things == same.things
    assert plan_text(one.plan) == plan_text(same.plan)
    assert one.things != other.things


@pytest.mark.parametrize("rooms", [0, 2, 10])
def test_other_numbers_of_rooms_are_refused(rooms):
    with pytest.raises(HearthError, match="from 3 to 9 rooms"):
        generate(rooms, 0, default())


@pytest.mark.parametrize("name", ["maple", "larch"])
def test_designed_plans_are_written_and_read_back_too(name):
    layout = library.load_layout(name, default())
    again = read(plan_text(layout.plan), "", default())
    assert [(t.name, t.box, t.yaw, t.on, t.inside) for t in again.things] == [
        (t.name, t.box, t.yaw, t.on, t.inside) for t in layout.things
    ]


@pytest.mark.parametrize(
    "text", ['the "blue" house', "bed: room", "12", "no", "a #b\\n\n\x85 {é🏠", "- [x]", "~", "1.5"]
)
def test_any_text_of_a_plan_reads_back(text):
    plan = library.load_layout("birch", default()).plan
    (first, *rest), named = plan.rooms, replace(plan.doorways[0], rooms=(text, plan.rooms[1].name), into=text)
    (piece, *others) = first.furniture
    odd = replace(first, name=text, furniture=(replace(piece, name=text), *others))
    again = parsed(replace(plan, name=text, about=text, character=text, rooms=(odd, *rest), doorways=(named,)))
    assert (again.name, again.about, again.character) == (text, text, text)
    assert again.rooms[0].name == text and again.rooms[0].furniture[0].name == text
    assert again.doorways[0].rooms[0] == text and again.doorways[0].into == text


def parsed(plan):
    faults = Faults("")
    found = read_plan(plan_text(plan), "", default(), faults)
    assert not list(faults)
    return found


@pytest.mark.slow
def test_a_thousand_in_a_row_lint_clean():
    for seed in range(1000):
        layout = generate(3 + seed % 7, seed, default())
        assert lint(scene(layout, default()), default()) == (), seed
