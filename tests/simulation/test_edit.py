from __future__ import annotations

import random

import pytest
from small_worlds import bound_step, node, random_graph, random_step

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, Node
from hearth.schemas.vocabulary import OPPOSITE, STATES
from hearth.simulation.engine import act
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.observation import reach
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world import edge_rows
from hearth.simulation.world.derived_homes import Movable
from hearth.simulation.world.edit import added_nodes, apply, edit, extended, free_id
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.simulation.world.world import World


def kitchen() -> Home:
    nodes = (
        node(1, "kitchen", "Rooms"),
        node(2, "bedroom", "Rooms"),
        node(3, "character", "Characters"),
        node(4, "table", "Furniture", ["SURFACES"], ["CLEAN"]),
        node(5, "cup", properties=["GRABBABLE", "RECIPIENT"], states=["CLEAN"]),
        node(6, "lamp", properties=["HAS_SWITCH"], states=["OFF", "FREE"]),
        node(7, "door", "Doors", ["CAN_OPEN"], ["OPEN"]),
    )
    edges = (
        Edge(3, "INSIDE", 1), Edge(4, "INSIDE", 1), Edge(5, "ON", 4), Edge(5, "INSIDE", 1), Edge(5, "CLOSE", 4),
        Edge(4, "CLOSE", 5), Edge(3, "CLOSE", 4), Edge(4, "CLOSE", 3), Edge(4, "FACING", 6), Edge(6, "INSIDE", 2),
        Edge(7, "BETWEEN", 1), Edge(7, "BETWEEN", 2), Edge(5, "MADE_BY", 6),
    )  # fmt: skip
    return Home.from_graph(EnvironmentGraph(nodes, edges), "kitchen", default())


ADDED = (
    node(1000, "plate", properties=["GRABBABLE"], states=["DIRTY"]),
    node(2000, "character", "Characters", ["PERSON"], ["SITTING"]),
)
EDGES = (
    Edge(1000, "ON", 4), Edge(1000, "INSIDE", 1), Edge(1000, "CLOSE", 4), Edge(3, "CLOSE", 1000),
    Edge(2000, "INSIDE", 2), Edge(2000, "CLOSE", 3), Edge(2000, "HOLDS_RH", 1000), Edge(1000, "FACING", 2000),
    Edge(6, "MADE_BY", 5),
)  # fmt: skip
REMOVED = (
    Edge(5, "ON", 4), Edge(4, "CLOSE", 5), Edge(3, "INSIDE", 1), Edge(7, "BETWEEN", 2), Edge(5, "MADE_BY", 6),
    Edge(4, "FACING", 6),
)  # fmt: skip
NEW_STATES = {4: ["DIRTY"], 6: ["ON"], 3: ["LYING"]}


def by_hand(home: Home) -> EnvironmentGraph:
    """The same done to the graph, edge by edge."""
    graph = World.start(home).graph()
    gone = {(e.source, e.relation, e.target) for e in REMOVED} | {(5, "CLOSE", 4)}
    new = {*EDGES, Edge(4, "CLOSE", 1000), Edge(1000, "CLOSE", 3), Edge(3, "CLOSE", 2000)}
    edges = {e for e in graph.edges if tuple(e) not in gone} | new
    changed = {4: ("DIRTY",), 6: ("FREE", "ON"), 3: ("LYING",)}
    nodes = [
        Node(n.id, n.class_name, n.category, n.properties, changed.get(n.id, n.states)) for n in (*graph.nodes, *ADDED)
    ]
    return EnvironmentGraph(tuple(nodes), tuple(sorted(edges)))


def test_an_extended_home_is_the_home_of_the_extended_graph():
    home = kitchen()
    before = World.start(home).graph()
    new = extended(home, ADDED, EDGES, REMOVED, NEW_STATES)
    assert World.start(new).graph() == by_hand(home)
    fresh = Home.from_graph(by_hand(home), "", default())
    for name in ("ids", "classes", "by_class", "properties", "rooms", "states", "agents", "agent_rows", "index"):
        assert getattr(new, name) == getattr(fresh, name), name
    assert new.rows == fresh.rows
    assert [new.able(a) for a in ("Grab", "Open", "Walk")] == [fresh.able(a) for a in ("Grab", "Open", "Walk")]
    assert World.start(home).graph() == before
    assert added_nodes(home, new) == ADDED
    assert new.node(5).states == ("FREE", "ON")


def test_changes_between_a_home_and_one_derived_from_it_rebuild_the_graph():
    home = kitchen()
    start = World.start(home)
    after = World.start(extended(home, ADDED, EDGES, REMOVED, NEW_STATES))
    again = World.start(Home.from_graph(by_hand(home), "", default()))
    change = after.changes(start)
    assert change == again.changes(start)
    edges = (set(start.edges()) | set(change.added)) - set(change.removed)
    assert edges == set(after.edges())
    states = {(n.id, s) for n in start.graph().nodes for s in n.states}
    states = (states | set(change.set_states)) - set(change.cleared_states)
    assert states == {(n.id, s) for n in after.graph().nodes for s in n.states}
    back = start.changes(after)
    assert (back.added, back.removed) == (change.removed, change.added)


def test_ids_below_the_homes_own_are_put_in_order():
    home = extended(kitchen(), [node(2000, "bowl")])
    new = extended(home, ADDED[:1], EDGES[:4], [Edge(5, "ON", 4)], {5: ["DIRTY"]})
    fresh = Home.from_graph(World.start(new).graph(), "", default())
    assert new.ids == [1, 2, 3, 4, 5, 6, 7, 1000, 2000]
    assert new.rows == fresh.rows
    assert new.states == fresh.states


@pytest.mark.parametrize("last", [8, 500], ids=["behind", "before"])
def test_movable_things_come_whether_other_new_nodes_are_in_order_or_not(last):
    home = extended(kitchen(), [node(last, "bowl")])
    cup = Movable(node(1001, "cup", properties=["GRABBABLE"]), "ON", home.index[4], home.index[1], 1 << home.index[6])
    edges = [Edge(100, "ON", 4), Edge(100, "INSIDE", 1)]
    new = extended(home, [node(100, "plate")], edges, (), {}, [cup])
    assert new.ids == sorted([1, 2, 3, 4, 5, 6, 7, last, 100, 1001])
    assert {(1001, "ON", 4), (1001, "INSIDE", 1), (1001, "CLOSE", 6), (6, "CLOSE", 1001), (100, "ON", 4)} <= {
        tuple(edge) for edge in World.start(new).graph().edges
    }
    fresh = Home.from_graph(World.start(new).graph(), "", default())
    assert new.rows == fresh.rows and new.classes == fresh.classes


def test_an_id_that_is_there_twice_is_named():
    """Also where it is below another of the new ones, which `extended` lays down without sorting."""
    cup = node(5, "cup", properties=["GRABBABLE"])
    with pytest.raises(HearthError, match="two nodes have the id 5"):
        extended(kitchen(), movable=[Movable(cup, "ON", 3, 0, 8)])


@pytest.mark.parametrize(
    "arguments",
    [
        ([node(5, "cup")],),
        ([node(9, "cup"), node(9, "cup")],),
        ((), [Edge(5, "ON", 99)]),
        ((), (), [Edge(99, "ON", 5)]),
        ((), (), (), {99: ["ON"]}),
    ],
)
def test_what_is_not_there_or_there_twice_is_refused(arguments):
    with pytest.raises(HearthError, match="BAD_GRAPH"):
        extended(kitchen(), *arguments)


# Worlds in the middle of an execution


def mid_execution(seed: int) -> World:
    """A world some steps after the start of a random home, with its memories."""
    rng = random.Random(seed)
    graph = random_graph(rng, characters=1 + seed % 2)
    world = World.start(Home.from_graph(graph, "", default()))
    for _ in range(30):
        result = act(world, random_step(rng, graph, rng.randrange(len(world.agents))), DEFAULT)
        world = world if isinstance(result, Failure) else result
    return world


def facts(world: World) -> tuple[set, set]:
    graph = world.graph()
    return {tuple(e) for e in graph.edges}, {(n.id, s) for n in graph.nodes for s in n.states}


@pytest.mark.parametrize("seed", range(30))
def test_edges_and_states_come_and_go_one_by_one(seed):
    world = mid_execution(seed)
    rng = random.Random(seed)
    ids = world.home.ids
    edges, states = facts(world)
    for _ in range(40):
        edge = Edge(rng.choice(ids), rng.choice(("ON", "INSIDE", "CLOSE", "FACING")), rng.choice(ids))
        if edges and rng.random() < 0.5:
            edge = Edge(*rng.choice(sorted(e for e in edges)))
        if edge.relation in ("BETWEEN", "HOLDS_RH", "HOLDS_LH"):
            continue
        both = {tuple(edge), (edge.target, "CLOSE", edge.source)} if edge.relation == "CLOSE" else {tuple(edge)}
        if rng.random() < 0.5:
            world, edges = edit(world, link=[edge], check=False), edges | both
        else:
            world, edges = edit(world, unlink=[edge]), edges - both
        node_id, state = rng.choice(ids), rng.choice(STATES)
        if rng.random() < 0.5:
            world = edit(world, set=[(node_id, state)], check=False)
            states = states - {(node_id, OPPOSITE[state])} | {(node_id, state)}
        else:
            world, states = edit(world, clear=[(node_id, state)]), states - {(node_id, state)}
        assert facts(world) == (edges, states), edge
    anew = World.start(Home.from_graph(world.graph(), "", default()))
    assert [edge_rows.room_of(world, i) for i in range(len(ids))] == [
        edge_rows.room_of(anew, i) for i in range(len(ids))
    ]


def test_what_was_unlinked_from_a_room_is_no_longer_in_it():
    world = World.start(kitchen())
    alone = edit(world, unlink=[Edge(6, "INSIDE", 2)])
    assert (edge_rows.room_of(alone, 5), edge_rows.room_of(alone, 1)) == (-1, 1)
    lower = edit(world, link=[Edge(6, "INSIDE", 1)])
    assert edge_rows.room_of(lower, 5) == 0
    assert reach.walkable(alone, alone.agents[0], False) >> 5 & 1 == 0


@pytest.mark.parametrize("seed", range(20))
def test_an_edited_world_goes_on_like_one_built_from_its_graph(seed):
    world = mid_execution(seed)
    new = node(1000, "cup", states=["CLEAN"])
    room = next(n.id for n in world.graph().nodes if n.category == "Rooms")
    place = next(n.id for n in world.graph().nodes if n.category in ("Props", "Furniture"))
    victim = max(i for i in world.home.ids if i not in (room, place) and i not in ids_of_agents(world))
    edited = edit(world, add=[new], remove=[victim], place={1000: ("ON", place)}, check=False)
    fresh = World.start(Home.from_graph(edited.graph(), "", default()))
    assert edited.graph() == fresh.graph()
    rng = random.Random(seed)
    for _ in range(30):
        step = random_step(rng, edited.graph(), rng.randrange(len(world.agents)))
        one, other = act(edited, step, DEFAULT), act(fresh, step, DEFAULT)
        if step.action == "PutObjBack":
            continue  # only the edited world remembers what was grabbed before
        assert isinstance(one, Failure) == isinstance(other, Failure), step
        if isinstance(one, World):
            edited, fresh = one, other
            assert facts(edited) == facts(fresh), step
    assert victim not in edited.home.index
    assert all(victim not in {edited.home.ids[i] for i in entry[:2]} for a in edited.agents for entry in a.origins)


def ids_of_agents(world: World) -> set[int]:
    return {world.home.ids[a.index] for a in world.agents}


@pytest.mark.parametrize("seed", range(30))
def test_applying_the_changes_between_two_worlds_gives_the_other(seed):
    before = mid_execution(seed)
    after = before
    rng = random.Random(seed)
    for _ in range(20):
        result = act(after, random_step(rng, before.graph()), DEFAULT)
        after = after if isinstance(result, Failure) else result
    assert facts(apply(before, after.changes(before))) == facts(after)
    assert facts(apply(after, before.changes(after))) == facts(before)
    start = World.start(before.home)
    assert facts(apply(start, after.changes(start))) == facts(after)


def test_memories_and_hands_survive_an_edit():
    home = kitchen()
    world = World.start(home)
    world = act(act(world, bound_step("Walk", [home.node(4)])), bound_step("Grab", [home.node(4)]))
    assert world.holding() == {0: (5,)}
    edited = edit(world, add=[node(1000, "cup")], link=[Edge(1000, "INSIDE", 1)], remove=[6], set=[(5, "DIRTY")])
    assert edited.holding() == {0: (5,)}
    back = act(edited, bound_step("PutObjBack", [home.node(4)]))
    assert Edge(5, "ON", 4) in back.edges()
    assert Edge(1000, "INSIDE", 1) in back.edges()
    in_between = edit(world, add=[node(0, "sponge")])
    assert in_between.home.ids[0] == 0
    back = act(in_between, bound_step("PutObjBack", [home.node(4)]))
    assert Edge(5, "ON", 4) in back.edges()


def test_a_new_character_of_a_lower_id_takes_nobodys_pose_or_memory():
    world = act(
        act(World.start(kitchen()), bound_step("Walk", [kitchen().node(4)])), bound_step("Grab", [kitchen().node(4)])
    )
    (me,) = world.agents
    me = me._replace(pose=Pose(1.0, 2.0, 90), stride=0.5)
    world = edit(World(world.home, world.states, (me,), world.moved), add=[node(0, "character", "Characters")])
    new, old = world.agents
    assert [world.home.ids[agent.index] for agent in (new, old)] == [0, 3]
    assert (new.pose, new.origins, new.held) == (None, (), 0)
    assert (old.pose, old.stride) == (me.pose, me.stride)
    assert [tuple(world.home.ids[i] for i in entry[:2]) for entry in old.origins] == [(5, 4)]


def test_placing_takes_a_thing_out_of_hands_and_away_from_where_it_was():
    home = kitchen()
    world = act(act(World.start(home), bound_step("Walk", [home.node(4)])), bound_step("Grab", [home.node(4)]))
    placed = edit(world, place={5: ("ON", 4)})
    assert placed.holding() == {0: ()}
    mine = {tuple(e) for e in placed.edges() if 5 in (e.source, e.target)}
    assert mine == {(5, "ON", 4), (5, "CLOSE", 4), (4, "CLOSE", 5), (5, "INSIDE", 1), (5, "MADE_BY", 6)}
    moved = edit(world, place={3: ("INSIDE", 2)})
    assert moved.holding() == {0: (5,)}
    assert {tuple(e) for e in moved.edges() if e.source == 3} == {
        (3, "INSIDE", 2), (3, "HOLDS_RH", 5), (3, "CLOSE", 5),
    }  # fmt: skip
    assert {tuple(e) for e in moved.edges() if e.source == 5} == {(5, "INSIDE", 2), (5, "CLOSE", 3), (5, "MADE_BY", 6)}


def test_what_a_placed_character_holds_comes_along_as_when_it_walks():
    home = kitchen()
    world = act(act(World.start(home), bound_step("Walk", [home.node(4)])), bound_step("Grab", [home.node(4)]))
    world = edit(world, add=[node(1000, "character", "Characters")], link=[Edge(1000, "CLOSE", 5)], check=False)
    walked = act(world, bound_step("Walk", [home.node(1)]))
    about = {tuple(e) for e in walked.edges() if 5 in (e.source, e.target)}
    for place in ((3, "INSIDE", 2), (3, "ON", 6)):  # the lamp is in the bedroom, too
        placed = edit(world, place={3: place[1:]}, check=False)
        assert {tuple(e) for e in placed.edges() if 5 in (e.source, e.target)} == about
    nowhere = edit(world, add=[node(1001, "rug")], place={3: ("ON", 1001)}, check=False)
    assert {tuple(e) for e in nowhere.edges() if e.source == 5} == {(5, "CLOSE", 3), (5, "MADE_BY", 6)}


@pytest.mark.parametrize(
    ("code", "change"),
    [
        ("NO_PLACE", {"place": {5: ("ON", 7)}}),
        ("NO_PLACE", {"link": [Edge(4, "INSIDE", 5)]}),
        ("NO_PLACE", {"place": {5: ("ON", 3)}}),
        ("NO_PLACE", {"place": {3: ("ON", 4)}}),
        ("NOT_AFFORDED", {"set": [(4, "ON")]}),
        ("NOT_AFFORDED", {"set": [(4, "SITTING")]}),
        ("NOT_AFFORDED", {"set": [(3, "ON")]}),
    ],
)
def test_what_does_not_fit_is_said_and_can_be_forced(code, change):
    world = World.start(kitchen())
    assert edit(world, **change).code == code
    assert isinstance(edit(world, **change, check=False), World)


def test_a_seat_bears_no_more_than_its_limit():
    nodes = [node(1, "kitchen"), node(2, "chair"), node(3, "character")]
    pillows = [node(10 + i, "pillow") for i in range(3)]
    home = Home.from_graph(EnvironmentGraph((*nodes, *pillows), (Edge(3, "INSIDE", 1),)), "", default())
    one = edit(World.start(home), place={10: ("ON", 2)})
    assert isinstance(one, World)
    assert edit(one, place={11: ("ON", 2)}).code == "OCCUPIED"
    assert edit(one, place={3: ("ON", 2)}).code == "OCCUPIED"
    assert isinstance(edit(one, place={10: ("ON", 2)}), World)
    assert isinstance(edit(World.start(home), place={3: ("ON", 2)}), World)


def test_free_ids_are_above_all_others():
    home = kitchen()
    assert free_id(home) == 1000
    assert free_id(home, 2000) == 2000
    assert free_id(extended(home, ADDED)) == 2001


def test_removing_a_character_frees_what_it_held():
    home = extended(kitchen(), ADDED, EDGES)
    world = edit(World.start(home), remove=[2000])
    assert world.holding() == {0: ()}
    assert 2000 not in {i for e in world.edges() for i in (e.source, e.target)}
    assert World.start(world.home).graph() == world.graph()


def test_homes_may_be_derived_in_a_row_a_thousand_times(maple):
    home = maple
    for _ in range(1200):
        home = extended(home, states={home.ids[-1]: ["CLEAN"]})
    more = extended(home, [node(9000, "table", "Furniture")])
    assert more.furniture == maple.furniture | 1 << more.index[9000]
    assert ground_of(home).ground is ground_of(maple).ground
