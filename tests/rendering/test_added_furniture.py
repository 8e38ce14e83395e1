"""Furniture that an environment adds: at walls, with the floor free where one stands and where legs are."""

import numpy as np

from hearth.kb.loading.load import default
from hearth.rendering.scene.added_furniture import LEGS, furnished
from hearth.rendering.scene.door_sweep import Floors
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene_preparation import prepared_scene
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node

ROOM = Node(1, "kitchen", "Rooms", (), (), None, Box((0, 1.3, 0), (5, 2.6, 4)))
FLOOR = Node(2, "floor", "Floor", (), (), None, Box((0, -0.05, 0), (5, 0.1, 4)))
WALL = Node(2, "wall", "Walls", (), (), None, Box((0, 1.3, -2.03), (5, 2.6, 0.06)), 0.0)
IN_ROOM = Edge(2, "INSIDE", 1)


def placed(added, *there):
    """The places of a room with some nodes, and one that is added."""
    edges = [IN_ROOM, *(Edge(node.id, "INSIDE", 1) for node in there[1:])]
    home = EnvironmentGraph((ROOM, *there), tuple(edges))
    more = (Edge(added.id, "INSIDE", 1), Edge(added.id, "ON", 2))
    graph = EnvironmentGraph((*home.nodes, added), (*edges, *more))
    prepared = prepared_scene(home, default())
    floors = Floors(prepared)
    return furnished(Places.start(home, default(), prepared), graph, floors), floors


def gaps(box):
    """Metres between a box and the walls along both axes."""
    return [2.5 - abs(box.center[0]) - box.size[0] / 2, 2.0 - abs(box.center[2]) - box.size[2] / 2]


def test_a_cupboard_at_a_wall_stands_there_in_its_own_size():
    cupboard = Node(1000, "kitchen_cabinet", "Furniture", ("CONTAINERS", "CAN_OPEN"), ("CLOSED",), None)
    pose = placed(cupboard, WALL)[0].poses[1000]
    assert min(pose.box.size) > 0.3
    assert abs(pose.box.center[1] - pose.box.size[1] / 2) < 0.01


def test_a_table_on_a_floor_stands_at_a_wall_and_not_in_the_way():
    table = Node(1000, "table", "Furniture", ("SURFACES", "MOVABLE"), (), None)
    assert min(gaps(placed(table, FLOOR)[0].poses[1000].box)) < 0.2


def test_a_chair_that_one_can_carry_is_furniture_and_other_things_that_one_can_carry_are_not():
    chair = Node(1000, "chair", "Furniture", ("GRABBABLE", "MOVABLE", "SITTABLE", "SURFACES"), (), None)
    assert min(gaps(placed(chair, FLOOR)[0].poses[1000].box)) < 0.2
    basket = Node(1000, "basket_for_clothes", "Furniture", ("GRABBABLE", "CONTAINERS"), (), None)
    assert 1000 not in placed(basket, FLOOR)[0].poses


def test_a_desk_leaves_room_for_the_legs_of_who_sits_on_a_chair():
    desk = Node(1000, "desk", "Furniture", ("SURFACES", "MOVABLE"), (), None)
    alone = placed(desk, FLOOR)[0].poses[1000].box
    # A chair whose legs' room is where the desk would stand: beside it, looking along the wall.
    along = 0 if alone.size[0] > alone.size[2] else 2
    side = -np.sign(alone.center[along])
    at = list(alone.center)
    at[along] += side * (alone.size[along] / 2 + 0.35)
    yaw = {(0, 1.0): 270.0, (0, -1.0): 90.0, (2, 1.0): 180.0, (2, -1.0): 0.0}[along, float(side)]
    size = (0.5, 0.9, 0.45) if along == 0 else (0.45, 0.9, 0.5)
    chair = Node(5, "chair", "Furniture", ("SITTABLE", "SURFACES"), (), None, Box((at[0], 0.45, at[2]), size), yaw)
    box = placed(desk, FLOOR, chair)[0].poses[1000].box
    front = at[along] - side * (0.25 + LEGS / 2)
    apart = abs(box.center[along] - front) - (box.size[along] + LEGS) / 2
    other = abs(box.center[2 - along] - at[2 - along]) - (box.size[2 - along] + 0.45) / 2
    assert max(apart, other) > -0.05
