"""Places of things in homes: as in real ones, in ours and in generated ones; and how that is measured."""

import json

import pytest
from typer.testing import CliRunner

from hearth import cli
from hearth.homes import library
from hearth.homes.geometry import bottom, intrusion, top
from hearth.homes.home_statistics import placement_distance, places
from hearth.homes.plans.layout import read
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.loading.load import default
from hearth.schemas.graph import Edge, EnvironmentGraph, Node

MOST = 0.25
"""Real homes differ by .07 to .23 from each other."""


def home(*edges):
    """A graph of things `class` or `class.2`, with the edges between them."""
    names = list(dict.fromkeys(name for one, _, other in edges for name in (one, other)))
    nodes = tuple(
        Node(number, name.split(".")[0], default().objects[name.split(".")[0]].category)
        for number, name in enumerate(names)
    )
    return EnvironmentGraph(nodes, tuple(Edge(names.index(a), r, names.index(b)) for a, r, b in edges))


def test_the_distance_is_weighted_by_the_smaller_count():
    one = home(("cup.1", "ON", "table"), ("cup.2", "ON", "table"), ("cup.3", "INSIDE", "cupboard"),
               ("mug", "INSIDE", "cupboard"), ("fryingpan", "ON", "stove"))  # fmt: skip
    other = home(("cup.1", "ON", "table"), ("mug.1", "ON", "table"), ("mug.2", "ON", "table"))
    # Cups: 1/3 of one are elsewhere, at weight 1; mugs: all, at weight 1; the pan is in one alone.
    found = placement_distance(places([one], default()), places([other], default()))
    assert found == pytest.approx((1 / 3 + 1) / 2, abs=1e-3)
    assert placement_distance(places([one], default()), places([one], default())) == 0
    assert placement_distance(places([one], default()), places([], default())) is None


def test_rooms_walls_and_people_are_no_places_and_synonyms_are_one_class():
    one = home(
        ("cup", "INSIDE", "kitchen"), ("drawing", "ON", "wall"), ("character", "ON", "bed"), ("pillow", "ON", "sofa")
    )
    assert dict(places([one], default())) == {"pillow": {("ON", "couch"): 1}}


@pytest.mark.parametrize("which", ["ours", "generated"])
def test_places_agree_with_real_homes(real_data, which):
    folder = real_data / "homes"
    theirs = places(
        [library.load_graph(name, default(), folder) for name in library.names(folder, alone=True)], default()
    )
    if which == "ours":
        graphs = [library.load_graph(name, default()) for name in library.names()]
    else:
        graphs = [scene(generate(3 + seed % 7, seed, default()), default()) for seed in range(500, 514)]
    assert placement_distance(places(graphs, default()), theirs) <= MOST


def test_the_command_says_how_far_homes_are_from_others(tmp_path):
    graph = {"nodes": [{"id": 1, "class_name": "kitchen", "category": "Rooms"},
                       {"id": 2, "class_name": "microwave", "category": "Appliances"},
                       {"id": 3, "class_name": "oven", "category": "Appliances"}],
             "edges": [{"from_id": 2, "relation_type": "ON", "to_id": 3}]}  # fmt: skip
    for node in graph["nodes"]:
        node.update(properties=[], states=[])
    (tmp_path / "maple.json").write_text(json.dumps(graph))
    command = ["home", "stats", "--against", str(tmp_path), "--generated", "1", "--json"]
    found = json.loads(CliRunner().invoke(cli.app, command).stdout)
    # A home there counts even if it is called as one of ours; ours have no microwave on an oven.
    assert found["placement_distance"] == found["ours"]["placement_distance"] == 1
    assert found["against"]["homes"] == 1 and found["against"]["placement_distance"] is None


def test_what_is_let_in_or_on_open_shelves_is_inside(tmp_path):
    text = """
home: hut
rooms:
  - name: kitchen
    at: [0, 0]
    size: [4.0, 4.0]
    furniture:
      - kitchen_counter: {wall: north, on: [faucet: {spot: [0.3, 0.1]}, cup], in: [sink: {spot: [0.3, 0.36]}]}
      - bookshelf: {wall: south, on: [book*8, novel*8], in: [photoframe*2]}
      - cupboard: {wall: east, in: [plate]}
doors:
  - {between: [kitchen, outside], wall: west}
"""
    things = {thing.name: thing for thing in read(text, "", default()).things}
    counter, sink = things["kitchen/kitchen_counter.1"], things["kitchen/kitchen_counter.1/sink.1"]
    assert sink.inside == counter.name and not sink.on
    assert bottom(sink.box) < top(counter.box) < top(sink.box) + 0.05
    shelf = [thing for name, thing in things.items() if name.startswith("kitchen/bookshelf.1/")]
    assert {(thing.class_name, bool(thing.inside)) for thing in shelf} == {
        ("book", False), ("novel", False), ("photoframe", True),
    }  # fmt: skip
    assert all(intrusion(a.box, b.box) <= 1e-6 for i, a in enumerate(shelf) for b in shelf[:i])


@pytest.mark.parametrize("which", ["ours", "generated"])
def test_nothing_is_where_nobody_puts_it(which):
    if which == "ours":
        graphs = [library.load_graph(name, default()) for name in library.names()]
    else:
        graphs = [scene(generate(3 + seed % 7, seed, default()), default()) for seed in range(7)]
    found = places(graphs, default())
    assert set(found["sink"]) <= {("INSIDE", "kitchen_counter"), ("INSIDE", "bathroom_counter")}
    assert set(found["microwave"]) == {("ON", "kitchen_counter")}
    inside = {
        name
        for name, where in found.items()
        if where.keys() & {("INSIDE", "kitchen_counter"), ("INSIDE", "bathroom_counter")}
    }
    assert inside == {"sink"}
