"""Keyframes of a recorded execution: the scene, the characters and the places of things after each tick."""

from collections.abc import Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice

from hearth.kb.knowledge import Knowledge
from hearth.kb.modifiers import numbers
from hearth.rendering.people.action_poses import Actor, elsewhere, initial_actors, moved, outermost
from hearth.rendering.people.bedding import turned_back
from hearth.rendering.people.clearance import faults
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.people.held_objects import held_things
from hearth.rendering.people.pushed_objects import slid
from hearth.rendering.people.skeleton import effort_of
from hearth.rendering.people.step_hands_and_gaze import posed, reach_for
from hearth.rendering.scene.added_furniture import furnished
from hearth.rendering.scene.door_sweep import Floors
from hearth.rendering.scene.film_variation import PLAIN, Variation, scattered
from hearth.rendering.scene.graph_history import graphs
from hearth.rendering.scene.instances import Thing
from hearth.rendering.scene.object_boxes import Places
from hearth.rendering.scene.scene import Scene
from hearth.rendering.scene.scene_preparation import PreparedScene, prepared_scene
from hearth.rendering.scene.standing_places import FreeFloor
from hearth.rendering.scene.triangles import StaticThings
from hearth.rendering.scene.visible_state_effects import at_time, changes
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, Point
from hearth.schemas.program import Step
from hearth.schemas.rng import derive
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.simulation.engine import Execution
from hearth.simulation.world.world import World


@dataclass(frozen=True, eq=False)
class Keyframe:
    """The scene after one tick of an execution.

    Attributes:
        tick: 0 before the first step, then 1 after it, ...
        steps: the tick's steps; empty at the start.
        scene: the scene.
        actors: the characters.
        places: positions of all things.
        floor: where one can stand and walk.
    """

    tick: int
    steps: tuple[Step, ...]
    scene: Scene
    actors: tuple[Actor, ...]
    places: Places
    floor: FreeFloor

    @property
    def acting(self) -> Actor:
        """The character that cameras follow: the first with a step in this tick, else the first."""
        return self.actors[acting(self.steps, len(self.actors))]


def acting(steps: Sequence[Step], count: int) -> int:
    """Return the number, below `count`, of the agent that cameras follow.

    The first with a step in this tick, else 0.
    """
    found = min((step.agent for step in steps), default=0)
    return found if found < count else 0


def named_nodes(steps: Sequence[Step], rooms: Container[int]) -> tuple[int, ...]:
    """Return the objects that steps name, in order, without rooms."""
    return tuple(
        dict.fromkeys(ref.node for step in steps for ref in step.objects if ref.node and ref.node not in rooms)
    )


def keyframes(
    execution: Execution, home: EnvironmentGraph, knowledge: Knowledge, *, seed: int = 0, hour: float = 10.0
) -> Iterator[Keyframe]:
    """Yield the scene at the start and after each tick of an execution.

    Args:
        execution: a recorded run; objects that its environment adds to the home or moves are placed by their relations.
        home: the home's graph as it was built, with boxes.
        knowledge: of its classes.
        seed: decides bodies, colours and designs.
        hour: of the day.

    Raises:
        HearthError: the home has no geometry.
    """
    yield from trajectory_of(execution, home, knowledge, seed=seed, hour=hour).keyframes


@dataclass(frozen=True, eq=False)
class Trajectory:
    """An execution as a sequence of keyframes.

    Attributes:
        prepared: the home's prepared scene.
        keyframes: at the start and after each tick.
        static: the things that never change, shared by all keyframes' scenes.
        variation: the random choices of the film.
    """

    prepared: PreparedScene
    keyframes: tuple[Keyframe, ...]
    static: StaticThings
    variation: Variation = PLAIN


def trajectory_of(
    execution: Execution,
    home: EnvironmentGraph,
    knowledge: Knowledge,
    *,
    seed: int = 0,
    hour: float = 10.0,
    variation: Variation | None = None,
) -> Trajectory:
    """All keyframes of an execution; see `keyframes`. A `variation` replaces seed and hour."""
    check_geometry(home)
    variation = variation or replace(PLAIN, seed=seed, hour=hour)
    placed = scattered(home, variation)
    prepared = prepared_scene(placed, knowledge, seed=variation.seed, hour=variation.hour)
    return trajectory_through(prepared, list(_keyframes(execution, placed, prepared, variation)), variation)


def trajectory_through(prepared: PreparedScene, found: Sequence[Keyframe], variation: Variation = PLAIN) -> Trajectory:
    """Return the trajectory through some keyframes, with the things apart that never change between them."""
    static = StaticThings(_static_things([keyframe.scene for keyframe in found]))
    kept = frozenset(static.things)
    return Trajectory(prepared, tuple(_without_static(keyframe, static, kept) for keyframe in found), static, variation)


def _without_static(keyframe: Keyframe, static: StaticThings, kept: frozenset[Thing]) -> Keyframe:
    moving = tuple(thing for thing in keyframe.scene.things if thing not in kept)
    return replace(keyframe, scene=replace(keyframe.scene, things=moving, static=static))


def check_geometry(home: EnvironmentGraph) -> None:
    """Check that a home has geometry.

    Raises:
        HearthError: no room has a box.
    """
    if not any(node.box and node.category == ROOM_CATEGORY for node in home.nodes):
        raise HearthError.of(
            Code.NOT_RENDERED, "the home has no geometry: no room has a box", suggestion="a designed home"
        )


def _static_things(scenes: Sequence[Scene]) -> tuple[Thing, ...]:
    """Return the things that are equal in all scenes, and from moment to moment."""
    common = set(scenes[0].things)
    for scene in scenes[1:]:
        common &= set(scene.things)
    return tuple(thing for thing in scenes[0].things if thing in common and not changes(thing))


def _keyframes(
    execution: Execution, home: EnvironmentGraph, prepared: PreparedScene, variation: Variation
) -> Iterator[Keyframe]:
    """Yield the keyframes of an execution, each scene with all of its things."""
    floors = Floors(prepared)
    ticks: list[tuple[Step, ...]] = [(), *execution.program.ticks()]
    places = Places.start(home, prepared.knowledge, prepared)
    actors: tuple[Actor, ...] = ()
    for tick, (graph, steps) in enumerate(zip(graphs(execution), ticks, strict=False)):
        if tick == 0:
            places = furnished(places, graph, floors).settled(graph)
            floor = floors.at(places.nodes())
            actors = initial_actors(graph, floor, places, people_seed(execution, variation.seed))
            actors = _wandered(actors, floor, variation) if variation.wander else actors
            actors = tuple(posed(actor, graph, places, None) for actor in actors)
            actors = standing(actors, execution.worlds[0])
            places = turned_back(places, actors)
        else:
            actors, places = advanced(actors, places, graph, floor, steps, execution.worlds[tick])
            floor = floors.at(places.nodes())
        yield Keyframe(tick, steps, scene_at(prepared, places, actors), actors, places, floor)


def people_seed(execution: Execution, seed: int) -> int:
    """Return the seed of the person who performs an execution: other programs and homes have other people."""
    return derive(seed, "people", execution.worlds[0].home.name, execution.program.title)


def _wandered(actors: tuple[Actor, ...], floor: FreeFloor, variation: Variation) -> tuple[Actor, ...]:
    """Return the actors; those that stand, at a random free spot of their room, facing a random direction."""
    found: list[Actor] = []
    for actor in actors:
        taken = [other.spot for other in (*found, *actors[len(found) + 1 :])]
        numbers = variation.random("start", actor.node.id)
        spot = floor.any_in(actor.room, numbers, taken) if actor.body_pose.posture == "standing" else None
        found.append(replace(actor, spot=spot, yaw=numbers.uniform(-180, 180)) if spot else actor)
    return tuple(found)


def standing(actors: Iterable[Actor], world: World) -> tuple[Actor, ...]:
    """Return the actors; those that stand, where the world says if it knows."""
    return tuple(
        actor
        if agent.pose is None or actor.body_pose.posture != "standing"
        else replace(actor, spot=agent.pose.point, yaw=agent.pose.yaw)
        for actor, agent in zip(actors, world.agents, strict=True)
    )


def advanced(
    actors: tuple[Actor, ...],
    places: Places,
    graph: EnvironmentGraph,
    floor: FreeFloor,
    steps: tuple[Step, ...],
    world: World,
) -> tuple[tuple[Actor, ...], Places]:
    """Actors and places after a tick, by the graph and the poses of the world after it."""
    by_agent = {step.agent: step for step in steps}
    after: list[Actor] = []
    known = replace(places, graph=graph)
    # Actors first walk, then objects are placed near them, then hands reach for the objects.
    for number, actor in enumerate(actors):
        others = [a.spot for a in (*after, *actors[number + 1 :])]
        within, step = floor.reachable_from(actor.spot), by_agent.get(number)
        there = moved(actor, graph, known, within, step, others)
        if step is not None and world.agents[number].pose is None:
            there = _with_room(there, actors, places, graph, step, elsewhere(there, graph, known, within, step, others))
        after.append(there)
    after = list(standing(after, world))
    settled = turned_back(slid(_settled(places, graph, after, steps), after, steps), after)
    return tuple(posed(actor, graph, settled, by_agent.get(n)) for n, actor in enumerate(after)), settled


def _settled(places: Places, graph: EnvironmentGraph, actors: Sequence[Actor], steps: Sequence[Step]) -> Places:
    """Yield the places after each step: objects are put down next to the actors, or where the steps say."""
    near = {actor.node.id: _put_down_at(actor) for actor in actors}
    put = {step.objects[0].node: numbers(step, "at") for step in steps if len(step.objects) == 2}
    return places.settled(graph, near, {node: (at[0], at[1]) for node, at in put.items() if node is not None and at})


BESIDE = (0.42, 0.0, 0.12)
"""Metres right of, above and before who sits or lies at which things are put down."""


def _put_down_at(actor: Actor) -> Point:
    """Return where an actor puts things down: near itself, and not under itself if it sits or lies."""
    return actor.position if actor.body_pose.posture == "standing" else actor.world(BESIDE)


STOOPED = 1.2
"""Cost of stooping as far as one can, in joints that are in solid things."""

TRIED = 10
"""Spots that are tried for an act."""


def _with_room(
    actor: Actor,
    actors: Sequence[Actor],
    places: Places,
    graph: EnvironmentGraph,
    step: Step,
    others: Iterator[Actor],
) -> Actor:
    """Return the actor where it acts with the fewest joints in solid things.

    As it is, or at one of some other spots.
    """
    if actor.body_pose.posture != "standing" or not gesture_of(step).near:
        return actor
    near = {ref.node for ref in step.objects if ref.node}
    reached = near | {outermost(node, places)[0] for node in near}

    def cost(tried: Actor) -> float:
        all_ = [tried if other.node.id == tried.node.id else other for other in actors]
        settled = _settled(places, graph, all_, (step,))
        there = posed(tried, graph, settled, step)
        arriving = reach_for(tried, there, places, step)
        wrong = faults(there, settled.solids, reached) + faults(arriving, places.solids, reached)
        return wrong + STOOPED * effort_of(arriving.body_pose, arriving.body.proportions)

    best, least = actor, cost(actor)
    for tried in islice(others if least >= 1 else (), TRIED):
        found = cost(tried)
        if found < least:
            best, least = tried, found
        if least < 1:
            break
    return best


def scene_at(prepared: PreparedScene, places: Places, actors: tuple[Actor, ...]) -> Scene:
    """Return the scene of one keyframe; held objects are drawn in the hands."""
    held = held_things(prepared, places, actors)
    nodes = [node for node in places.nodes() if node.id not in held]
    figures = [(actor.node, actor.figure(), actor.position, actor.yaw) for actor in actors]
    scene = prepared.scene(nodes, figures)
    things = (*scene.things, *(thing for things in held.values() for thing in things))
    return replace(scene, things=tuple(now for thing in things for now in at_time(thing, 0.0)))
