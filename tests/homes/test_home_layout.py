"""The layout of a plan: nothing stands in anything else, nothing floats, everywhere can be walked to."""

import random
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hearth.homes import library
from hearth.homes.geometry import bottom, footprint, intrusion, top
from hearth.homes.object_shapes import form
from hearth.homes.plans.home_shell import interior
from hearth.homes.plans.layout import read
from hearth.homes.plans.walkable_floor import stands_on_floor
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError

HOMES = library.names()
SEVEN = ("birch", "cedar", "juniper", "larch", "maple", "rowan", "willow")
ROOMS = {"bathroom", "bedroom", "dining_room", "entrance_hall", "home_office", "kids_bedroom", "kitchen", "living_room"}


@pytest.fixture(params=SEVEN)
def layout(request):
    return library.load_layout(request.param, default())


def test_there_are_seven_homes_of_four_to_seven_rooms_that_differ():
    plans = [library.load_layout(name, default()).plan for name in SEVEN]
    assert set(SEVEN) <= set(HOMES)
    assert all(4 <= len(plan.rooms) <= 7 for plan in plans)
    assert {len(plan.rooms) for plan in plans} == {4, 5, 6, 7}
    assert {room.class_name for plan in plans for room in plan.rooms} == ROOMS
    assert len({tuple(sorted(room.class_name for room in plan.rooms)) for plan in plans}) >= 6


def test_each_home_has_what_programs_ask_for_first(layout):
    classes = {thing.class_name for thing in layout.things}
    assert classes & {"table", "kitchen_table", "dining_table"}
    assert classes >= {"coffee_table", "fridge", "dishwasher", "stove", "couch", "bed", "desk", "computer"}
    assert classes >= {"television", "window", "curtain", "light", "ceilinglamp", "door", "drawing"}
    by_name = {thing.name: thing for thing in layout.things}
    assert any(t.class_name == "computer" and by_name[t.on].class_name == "desk" for t in layout.things if t.on)


def test_things_stay_in_their_rooms_and_out_of_each_other(layout):
    by_room = {room.name: interior(room).inset(-0.011) for room in layout.plan.rooms}
    solid = [t for t in layout.things if t.mount in ("floor", "wall", "item", "ceiling") and not t.inside]
    for thing in solid:
        assert by_room[thing.room].contains(footprint(thing.box)), thing.name
    centers = np.array([t.box.center for t in solid])
    sizes = np.array([t.box.size for t in solid])
    depth = ((sizes[:, None] + sizes[None]) / 2 - abs(centers[:, None] - centers[None])).min(axis=2)
    for i, j in np.argwhere(np.triu(depth, 1) > 0.012):
        one, other = sorted((solid[i].name, solid[j].name), key=len)
        assert other.startswith(one + "/"), (one, other)


def test_what_is_on_or_in_things_is_where_they_are(layout):
    by_name = {thing.name: thing for thing in layout.things}
    for thing in layout.things:
        if thing.mount == "item" and thing.on in by_name:
            under = by_name[thing.on]
            assert footprint(under.box).contains(footprint(thing.box)), thing.name
            assert bottom(under.box) < bottom(thing.box) < top(under.box) + 0.29, thing.name
        if thing.inside:
            holder = by_name[thing.inside]
            assert footprint(holder.box).contains(footprint(thing.box)), thing.name
            assert bottom(thing.box) >= bottom(holder.box) - 0.001, thing.name


def test_all_rooms_join_on_foot_and_the_character_stands_free(layout):
    floor = layout.floor
    regions = floor.regions()
    main = np.bincount(regions[regions > 0]).argmax()
    for number in range(len(layout.plan.rooms)):
        assert ((regions == main) & (floor.room == number)).sum() > 20, layout.plan.rooms[number].name
    x, _, z = layout.character.box.center
    assert regions[floor.index(x, z)] == main
    assert not any(intrusion(layout.character.box, t.box) > 0 for t in layout.things if stands_on_floor(t))


def test_the_floor_is_free_where_nothing_stands_and_nowhere_else(layout):
    floor = layout.floor
    standing = [footprint(t.box) for t in layout.things if stands_on_floor(t)]
    inner = {room.name: interior(room) for room in layout.plan.rooms}
    pick = random.Random(1)
    cells = [(pick.randrange(floor.free.shape[0]), pick.randrange(floor.free.shape[1])) for _ in range(600)]
    for i, j in cells:
        point = floor.center(i, j)
        # The edge itself may go either way.
        if any(rect.inset(0.002).holds(*point) for rect in standing):
            assert not floor.free[i, j]
        elif not any(rect.inset(-0.002).holds(*point) for rect in standing):
            assert floor.free[i, j] or not any(rect.inset(0.002).holds(*point) for rect in inner.values())


def test_walls_have_holes_where_doors_and_windows_are(layout):
    walls = [t.box for t in layout.things if t.class_name == "wall"]
    assert len(walls) > 40
    for thing in layout.things:
        if thing.class_name in ("doorjamb", "window"):
            assert all(intrusion(thing.box, wall) < 1e-3 for wall in walls), thing.name


def test_a_table_is_laid_before_every_chair(layout):
    chairs = [t for t in layout.things if t.class_name == "chair"]
    laid = [t for t in layout.things if t.class_name == "plate" and t.on and "table" in t.on and "rack" not in t.on]
    assert laid
    for plate in laid:
        gaps = [
            max(abs(c.box.center[0] - plate.box.center[0]), abs(c.box.center[2] - plate.box.center[2])) for c in chairs
        ]
        assert min(gaps) < 0.6, plate.name


ITEMS = ("plate", "cup", "book", "television", "pillow", "pen", "milk", "towel", "microwave", "clothes_shirt", "vase")
SUPPORTS = ("table", "desk", "bookshelf", "bed", "coffee_table", "shoe_rack")
HOLDERS = ("fridge", "closet", "nightstand", "cupboard", "basket_for_clothes")


@settings(max_examples=60)
@given(
    st.sampled_from([(name, "on") for name in SUPPORTS] + [(name, "in") for name in HOLDERS]),
    st.lists(st.tuples(st.sampled_from(ITEMS), st.integers(1, 6)), min_size=1, max_size=6, unique_by=lambda i: i[0]),
)
def test_whatever_is_put_anywhere_does_not_overlap_or_stick_out(where, items):
    name, key = where
    things = ", ".join(f"{item}*{count}" for item, count in items)
    text = (
        f"home: x\nrooms:\n- name: kitchen\n  at: [0, 0]\n  size: [5, 5]\n  furniture:\n"
        f"  - {name}: {{wall: north, {key}: [{things}]}}\n"
    )
    try:
        layout = read(text, "", default())
    except HearthError as error:
        assert all("no room left" in fault.message for fault in error.diagnostics)
        return
    held = [t for t in layout.things if t.mount == "item" and "/" in t.name.partition("/")[2]]
    owner = next(t for t in layout.things if t.class_name == name)
    assert len(held) == sum(count for _, count in items)
    assert all(footprint(owner.box).contains(footprint(t.box)) for t in held)
    assert all(intrusion(a.box, b.box) < 1e-3 for a, b in combinations(held, 2))


@settings(max_examples=25)
@given(st.randoms(use_true_random=False))
def test_a_damaged_plan_is_read_or_refused_but_never_breaks(pick):
    lines = library._file("maple", None).read_text().splitlines()
    for _ in range(pick.randint(1, 4)):
        i = pick.randrange(len(lines))
        kind = pick.randrange(4)
        if kind == 0:
            del lines[i]
        elif kind == 1:
            lines[i] = lines[pick.randrange(len(lines))]
        elif kind == 2:
            lines[i] = lines[i][: pick.randrange(len(lines[i]) + 1)]
        else:
            lines[i] = "".join(pick.choice("0-9 :[]{}*,x") if pick.random() < 0.1 else c for c in lines[i])
    try:
        read("\n".join(lines), "damaged.yaml", default())
    except HearthError as error:
        assert error.diagnostics
        assert all(fault.file == "damaged.yaml" for fault in error.diagnostics)


def test_a_class_by_another_name_has_its_form():
    assert form("sofa", default()) == form("couch", default())
