"""Films: people walk around furniture, feet stay put, things change when hands arrive, time adds up."""

import re
from dataclasses import replace
from itertools import pairwise
from math import hypot

import numpy as np
import pytest

pytest.importorskip("open3d")

from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.player import page
from hearth.rendering.film.video import film, record, times
from hearth.rendering.film.video_file import Writer
from hearth.rendering.people.motion import frames, spans
from hearth.rendering.people.motion_tracks import RELAX
from hearth.rendering.people.pose_blends import blended
from hearth.rendering.scene.routes import led_on, path, ways_of
from hearth.rendering.scene.standing_places import FreeFloor
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Box, Edge, EnvironmentGraph, Node
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

PROGRAM = "Put it away\nOn the table\n\n\n[Walk] <cup> (1)\n[Grab] <cup> (1)\n[Walk] <table> (1)\n" \
    "[PutBack] <cup> (1) <table> (1)\n[Sit] <chair> (1)\n[StandUp]\n"  # fmt: skip
ROOM, ME, TABLE, CHAIR, SHELF, CUP = range(1, 7)
FPS = 12.0


def node(number, name, category, center, size, properties=(), yaw=0.0):
    return Node(number, name, category, properties, (), None, Box(center, size), yaw)


HOME = EnvironmentGraph(
    (
        node(ROOM, "kitchen", "Rooms", (0, 1.3, 0), (5, 2.6, 4), yaw=None),
        node(ME, "character", "Characters", (1.6, 0.85, 1.4), (0.4, 1.7, 0.4)),
        node(TABLE, "table", "Furniture", (0.0, 0.37, 0.0), (1.2, 0.74, 0.8), ("SURFACES",)),
        node(CHAIR, "chair", "Furniture", (1.2, 0.45, -0.4), (0.45, 0.9, 0.48), ("SITTABLE", "SURFACES"), 90.0),
        node(SHELF, "kitchen_counter", "Furniture", (-1.8, 0.44, -1.6), (1.2, 0.88, 0.6), ("SURFACES",)),
        node(CUP, "cup", "Props", (-1.8, 0.93, -1.6), (0.1, 0.1, 0.08), ("GRABBABLE", "RECIPIENT")),
    ),
    (*(Edge(number, "INSIDE", ROOM) for number in range(2, 7)), Edge(CUP, "ON", SHELF)),
)


@pytest.fixture(scope="module")
def trajectory():
    program, faults = parse_program(PROGRAM.replace("[Sit]", "[Walk] <chair> (1)\n[Sit]"))
    assert not faults
    bound = program.bound({("cup", 1): CUP, ("table", 1): TABLE, ("chair", 1): CHAIR})
    done = run(World.start(Home.from_graph(HOME, "", default())), bound)
    assert done.executable, done.failure
    return trajectory_of(done, HOME, default())


@pytest.fixture(scope="module")
def shown(trajectory):
    return list(frames(trajectory, FPS))


def test_steps_follow_each_other_and_frames_fill_them(trajectory, shown):
    found = spans(trajectory)
    assert [span.tick for span in found] == list(range(8))
    assert all(one.end == two.start for one, two in pairwise(found))
    assert all(span.end > span.start for span in found)
    assert len(shown) == np.ceil(found[-1].end * FPS)
    assert all(found[frame.tick].start <= frame.time < found[frame.tick].end for frame in shown)


def test_a_film_ends_each_step_where_the_snapshot_is(trajectory, shown):
    for tick in range(1, 8):
        last = [frame for frame in shown if frame.tick == tick][-1]
        assert last.actors == trajectory.keyframes[tick].actors


def test_people_walk_at_a_walking_pace_around_furniture(shown):
    for one, two in pairwise(shown):
        (x0, z0), (x1, z1) = one.actors[0].spot, two.actors[0].spot
        assert hypot(x1 - x0, z1 - z0) < 1.5 / FPS
    walking = [frame for frame in shown if frame.actors[0].body_pose.feet]
    assert len(walking) > 10
    for frame in walking:
        x, z = frame.actors[0].spot
        assert abs(x) > 0.6 or abs(z) > 0.4, (frame.time, x, z)


def joints(actor):
    return {name: np.array(actor.world(tuple(at))) for name, at in actor.figure().joints().items()}


def test_feet_on_the_floor_stay_where_they_are(shown):
    """Walking, turning, sitting down and getting up: an ankle or a tip of toes on the floor does not slide."""
    sliding = []
    for one, two in pairwise(shown):
        a, b, own = joints(one.actors[0]), joints(two.actors[0]), one.actors[0].body.proportions
        for name, low in (("ankle", own.ankle), ("toe", 0.012 * own.height)):
            for side in "rl":
                start, end = a[f"{name}_{side}"], b[f"{name}_{side}"]
                if max(start[1], end[1]) < low + 0.006:
                    sliding.append(hypot(end[0] - start[0], end[2] - start[2]) * FPS)
    assert len(sliding) > 200
    assert np.median(sliding) < 1e-3
    assert np.percentile(sliding, 95) < 0.05


def test_nobody_jumps(shown):
    """Heads stay below 2.5 m/s, and no hand or head changes its speed by 15 cm between frames."""
    found = [joints(frame.actors[0]) for frame in shown]
    assert max(np.linalg.norm(b["head"] - a["head"]) for a, b in pairwise(found)) * FPS < 2.5
    for a, b, c in zip(found, found[1:], found[2:], strict=False):
        for name in ("head", "pelvis", "hand_r", "hand_l"):
            assert np.linalg.norm(c[name] - 2 * b[name] + a[name]) < 0.15, name


@pytest.mark.parametrize("far", [0.15, 0.3, 0.45])
@pytest.mark.parametrize("phase", [0.01, 0.03, 0.05, 0.08])
def test_hands_neither_start_nor_stop_at_once(shown, far, phase):
    """Even in the shortest blends, and whenever the frames are taken."""
    actor = shown[0].actors[0]
    one, other = (replace(actor, body_pose=replace(actor.body_pose, right=(x, 1.1, 0.35))) for x in (0.1, 0.1 - far))
    blend = blended(one, other, RELAX)
    still = [one] * 2
    moving = [blend.at(time / blend.seconds) for time in np.arange(phase, blend.seconds, 0.1)]
    found = [joints(each)["hand_r"] for each in (*still, *moving, other, other)]
    assert max(np.linalg.norm(c - 2 * b + a) for a, b, c in zip(found, found[1:], found[2:], strict=False)) < 0.12


def test_a_held_cup_is_in_the_palm(shown):
    from hearth.rendering.scene.instances import placed

    held = [frame for frame in shown if CUP in frame.holds.get(ME, {})]
    assert len(held) > 20
    for frame in held:
        actor, cup = frame.actors[0], frame.scene.find(CUP)
        palm = np.array(actor.hand(frame.holds[ME][CUP]))
        assert np.linalg.norm(placed(cup).corners.reshape(-1, 3) - palm, axis=1).min() < 0.03


def test_the_cup_changes_hands_when_the_hand_is_there(shown):
    grabbing = [frame for frame in shown if frame.tick == 2]
    on_shelf = [frame for frame in grabbing if frame.scene.find(CUP).position[0] == pytest.approx(-1.8)]
    assert 0 < len(on_shelf) < len(grabbing)
    hand = on_shelf[-1].actors[0].hand("right")
    assert hypot(hand[0] + 1.8, hand[1] - 0.93) < 0.2
    held = grabbing[-1]
    assert np.linalg.norm(np.subtract(held.scene.find(CUP).position, held.actors[0].hand("right"))) < 0.22


def test_the_way_leads_around_and_through_doors():
    rooms = [
        node(1, "kitchen", "Rooms", (0, 1.3, 0), (4, 2.6, 4)),
        node(2, "bedroom", "Rooms", (4.1, 1.3, 0), (4, 2.6, 4)),
    ]
    jamb = node(3, "doorjamb", "Doors", (2.05, 1, 1.2), (0.1, 2, 0.9))
    ways = ways_of(rooms, [*rooms, jamb])
    way = path(ways, (0.0, -1.5), (4.0, -1.5))
    assert way[0] == (0.0, -1.5)
    assert way[-1] == (4.0, -1.5)
    crossing = next(
        a[1] + (b[1] - a[1]) * (2.05 - a[0]) / (b[0] - a[0]) for a, b in pairwise(way) if a[0] < 2.05 <= b[0]
    )
    assert 0.75 < crossing < 1.65
    assert path(None, (0, 0), (1, 1)) == ((0, 0), (1, 1))


def test_films_are_written_with_the_times_of_their_steps(trajectory, tmp_path):
    done = record(trajectory, HOME, tmp_path, "auto", size=(48, 36), fps=2.5)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["auto.mp4", "auto.webm"]
    assert "[Grab] <cup>" in done.steps[2]["steps"][0]
    assert all(step["cameras"] for step in done.steps)
    assert len(done.keyframes) == 8
    import cv2

    for file in done.files:
        video = cv2.VideoCapture(str(file))
        count = 0
        while video.read()[0]:
            count += 1
        assert count == done.frames


@pytest.mark.slow
def test_films_have_the_same_bytes_each_time(trajectory, tmp_path):
    record(trajectory, HOME, tmp_path, "auto", size=(48, 36), fps=2.5, suffixes=(".mp4",))
    first = (tmp_path / "auto.mp4").read_bytes()
    record(trajectory, HOME, tmp_path, "auto", size=(48, 36), fps=2.5, suffixes=(".mp4",))
    assert (tmp_path / "auto.mp4").read_bytes() == first


def test_every_kind_of_camera_sees_something(trajectory):
    for view in ("top", "first", "third", "kitchen.1.2"):
        shot = next(film(trajectory, HOME, view, size=(32, 24), fps=5.0))
        assert shot.rgb.shape == (24, 32, 3)
        assert shot.rgb.std() > 5, view


def test_unknown_cameras_and_formats_are_told(trajectory, tmp_path):
    with pytest.raises(HearthError, match="no camera `attic`"):
        next(film(trajectory, HOME, "attic"))
    with pytest.raises(HearthError, match="can't write"):
        Writer(tmp_path / "film.avi", 32, 24, 5.0)


def test_the_page_has_a_row_for_each_step(trajectory):
    steps = times(spans(trajectory))
    text = page("Tea <for> two", ["auto.webm"], steps)
    assert "Tea &lt;for&gt; two" in text
    assert len(re.findall("<li ", text)) == len(steps)
    assert f'data-start="{steps[3]["start"]}"' in text
    assert "http" not in text


FETCH = "[Walk] <cup> (1){}\n[Grab] <cup> (1){}\n[Walk] <table> (1){}\n[PutBack] <cup> (1) <table> (1){}\n"


def filmed(steps):
    program, faults = parse_program(f"Fetch\nIt.\n\n\n{steps}")
    assert not faults
    bound = program.bound({("cup", 1): CUP, ("table", 1): TABLE})
    done = run(World.start(Home.from_graph(HOME, "", default())), bound)
    assert done.executable, done.failure
    return done, trajectory_of(done, HOME, default())


def test_the_times_of_a_film_differ_by_the_speed():
    taken = {}
    for speed in ("slow", "normal", "fast"):
        _, trajectory = filmed(FETCH.format(*[f" {{speed={speed}}}"] * 4))
        taken[speed] = [span.end - span.start for span in spans(trajectory)[1:]]
    _, plain = filmed(FETCH.format("", "", "", ""))
    assert taken["normal"] == pytest.approx([span.end - span.start for span in spans(plain)[1:]])
    assert taken["slow"] == pytest.approx([2 * seconds for seconds in taken["normal"]])
    assert taken["fast"] == pytest.approx([seconds / 2 for seconds in taken["normal"]])


def test_the_hand_that_is_said_reaches_and_holds():
    _, trajectory = filmed(FETCH.format("", " {hand=left}", "", ""))
    holding = trajectory.keyframes[2].actors[0].body_pose
    assert holding.left is not None and holding.right is None
    reaching = [frame.actors[0].body_pose for frame in frames(trajectory, 12.0) if frame.tick == 2]
    assert all(pose.right is None for pose in reaching)


def test_a_thing_stands_where_it_was_put():
    _, trajectory = filmed(FETCH.format("", "", "", " {at=0.4,-0.2}"))
    box = trajectory.keyframes[-1].places.poses[CUP].box
    assert (box.center[0], box.center[2]) == (0.4, -0.2) and box.center[1] == pytest.approx(0.79, abs=0.01)


def test_a_film_shows_characters_where_the_world_has_them():
    moves = "[Turnleft]\n[Walktowards] <cup> (1)\n[Walktowards] <cup> (1)\n[Walk] <cup> (1) {facing=200}\n"
    done, trajectory = filmed(moves)
    for keyframe, world in zip(trajectory.keyframes, done.worlds, strict=True):
        pose, actor = world.agents[0].pose, keyframe.actors[0]
        assert (actor.spot, actor.yaw) == (pose.point, pose.yaw)
    last = list(frames(trajectory, 12.0))[-1].actors[0]
    assert (last.spot, last.yaw) == (done.final.agents[0].pose.point, 200.0)


ROOM = node(1, "kitchen", "Rooms", (0, 1.3, 0), (4, 2.6, 4))


def standing(number, name, at, size, *states, properties=()):
    return Node(number, name, "Furniture", states=states, properties=properties, box=Box(at, size))


def crosses(way, thing):
    """Return whether a way leads through a thing's box."""
    (x, _, z), (w, _, d) = thing.box
    points = [np.add(a, (np.array(b) - a) * s) for a, b in pairwise(way) for s in np.linspace(0, 1, 200)]
    return any(abs(p[0] - x) < w / 2 - 0.02 and abs(p[1] - z) < d / 2 - 0.02 for p in points)


def test_without_a_way_one_comes_as_near_as_one_can_and_never_through():
    shelf = standing(2, "bookshelf", (0, 1, 0), (0.4, 2, 4))
    way = path(ways_of([ROOM], [ROOM, shelf]), (-1.5, 0.0), (1.5, 1.0))
    assert not crosses(way, shelf)
    assert way[-1][0] < 0 and abs(way[-1][1] - 1.0) < 0.2


def test_one_squeezes_through_where_there_is_no_space_for_two():
    shelves = [standing(2, "bookshelf", (0, 1, -1.15), (0.4, 2, 1.7)), standing(3, "bookshelf", (0, 1, 1), (0.4, 2, 2))]
    way = path(ways_of([ROOM], [ROOM, *shelves]), (-1.5, 1.0), (1.5, 1.0))
    assert way[-1] == (1.5, 1.0)
    assert not any(crosses(way, shelf) for shelf in shelves)


def test_to_where_the_world_has_somebody_one_passes_between_things_however_near():
    """By the spaces that bodies need no way leads through a gap of 15 cm; the straight line leads through a shelf."""
    shelves = [
        standing(2, "bookshelf", (0, 1, -1.0), (0.4, 2, 2)),
        standing(3, "bookshelf", (0, 1, 1.1), (0.4, 2, 1.8)),
    ]
    floor, goal = ways_of([ROOM], [ROOM, *shelves]), (1.5, 1.0)
    route = path(floor, (-1.5, 1.0), goal)
    assert route[-1] != goal
    led = led_on(floor, route, goal)
    assert led[: len(route)] == route
    assert led[-1] == goal
    assert not any(crosses(led, shelf) for shelf in shelves)
    assert led_on(None, route, goal) == (*route, goal)
    assert led_on(floor, led, goal) == led


def inside(way, things):
    """Metres of a way in things' boxes."""
    points = np.concatenate(
        [np.linspace(a, b, max(2, int(np.hypot(*np.subtract(b, a)) * 200))) for a, b in pairwise(way)]
    )
    steps = np.hypot(*np.diff(points, axis=0).T)
    halves = [(np.array(each.box.center)[[0, 2]], np.array(each.box.size)[[0, 2]] / 2) for each in things]
    return float(sum(steps[(np.abs(points[1:] - at) < half).all(axis=1)].sum() for at, half in halves))


def test_out_of_what_is_all_around_one_goes_through_the_least_of_it_and_then_by_a_way():
    around = [
        standing(2, "bookshelf", (-1.5, 1, 0.8), (1.2, 2, 0.4)),
        standing(3, "bookshelf", (-1.5, 1, -0.8), (1.2, 2, 0.4)),
        standing(4, "bookshelf", (-0.7, 1, 0.0), (0.8, 2, 2.0)),
    ]
    beyond = standing(5, "bookshelf", (1.0, 1, -0.6), (0.4, 2, 2.8))
    boxed, goal = (-1.5, 0.0), (1.6, -1.0)
    wall = standing(6, "bookshelf", (-1.95, 1, 0.0), (0.1, 2, 4.0))
    things = [*around, beyond, wall]
    floor = ways_of([ROOM], [ROOM, *things])
    led = led_on(floor, path(floor, boxed, goal), goal)
    assert led[-1] == goal
    assert inside(led, things) < 0.55, "through one shelf, and around the other"
    assert inside((boxed, goal), things) > 0.9
    assert led == led_on(floor, path(floor, boxed, goal), goal)


def test_into_a_room_without_a_door_one_goes_through_the_wall_where_it_is_thinnest():
    walls = [
        standing(2, "wall", (0, 1, -1.0), (0.8, 2, 2.0)),
        standing(3, "wall", (0, 1, 1.0), (0.2, 2, 2.0)),
    ]
    floor, start, goal = ways_of([ROOM], [ROOM, *walls]), (-1.5, -1.0), (1.5, -1.0)
    led = led_on(floor, path(floor, start, goal), goal)
    assert led[-1] == goal
    assert inside(led, walls) < 0.3 < 0.7 < inside((start, goal), walls)


def test_who_reads_looks_to_the_room_and_not_at_a_shelf():
    shelf = standing(2, "bookshelf", (0, 1, 1.5), (4, 2, 0.4))
    floor = FreeFloor.of([ROOM], [shelf], walkable=ways_of([ROOM], [ROOM, shelf]))
    ahead, away = floor.outlook((0.0, 0.9), 0.0), floor.outlook((0.0, 0.0), 180.0)
    assert away == 180.0, "nothing is close"
    assert abs((ahead + 180) % 360 - 180) >= 90
    assert FreeFloor.of([ROOM], [shelf]).outlook((0.0, 0.9), 0.0) == 0.0, "nothing is known of the floor"


def test_one_stands_farther_from_a_switch_on_the_wall_than_from_a_low_thing():
    def far(height):
        spot = next(FreeFloor.of([ROOM], []).spots_for(Box((0, height, -1.9), (0.1, 0.1, 0.03)), 0.0, ROOM.id, None))
        return spot[1] + 1.9 - 0.015

    assert far(1.3) == pytest.approx(0.46, abs=0.06)
    assert far(0.5) == pytest.approx(0.32, abs=0.06)


def test_open_leaves_are_walked_around_and_closed_ones_are_not():
    opened = standing(2, "door", (0, 1, -0.4), (0.05, 2, 3.2), "OPEN")
    closed = standing(2, "door", (0, 1, -0.4), (0.05, 2, 3.2), "CLOSED")
    jamb = standing(3, "doorjamb", (0, 1, 0.5), (0.1, 2, 0.9))
    start, goal = (-1.0, 0.0), (1.0, 0.0)
    assert not crosses(path(ways_of([ROOM], [ROOM, jamb, opened]), start, goal), opened)
    assert path(ways_of([ROOM], [ROOM, jamb, closed]), start, goal) == (start, goal)
    assert not crosses(path(ways_of([ROOM], [ROOM, closed]), start, goal), closed), "a door that hangs nowhere"


def test_a_pillow_on_the_floor_is_stepped_over():
    pillow = standing(2, "pillow", (0, 0.08, 0), (0.6, 0.16, 3.9), properties=("GRABBABLE",))
    chest = standing(2, "chest", (0, 0.08, 0), (0.6, 0.16, 3.9))
    start, goal = (-1.0, 0.0), (1.0, 0.0)
    assert path(ways_of([ROOM], [ROOM, pillow]), start, goal) == (start, goal)
    assert path(ways_of([ROOM], [ROOM, chest]), start, goal)[-1] != goal


def test_from_a_seat_one_does_not_climb_over_the_table():
    chair = standing(2, "chair", (0, 0.45, 0.6), (0.4, 0.9, 0.4))
    table = standing(3, "table", (0, 0.37, -0.3), (2.4, 0.74, 1.4))
    floor = ways_of([ROOM], [ROOM, chair, table])
    entry = floor.entry(floor.wide, (0.0, 0.6))
    assert entry is not None and entry[1] > 0.6
    assert not crosses(path(floor, (0.0, 0.6), (0.0, -1.6)), table)
