"""A gallery of steps: each of another action if it can be, in another home, by another person, at another hour."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import cycle, islice
from typing import NamedTuple

from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.kb.knowledge import Knowledge
from hearth.rendering.arrays import Image
from hearth.rendering.cameras.recognition import shows
from hearth.rendering.cameras.viewpoints import best_view, room_views
from hearth.rendering.cameras.visibility import seen_as
from hearth.rendering.film.execution_keyframes import Keyframe, Trajectory, named_nodes, trajectory_of
from hearth.rendering.modalities import pictures_of
from hearth.rendering.people.gestures import gesture_of
from hearth.rendering.rays.camera_shot import shoot
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph
from hearth.schemas.program import Program, Step
from hearth.schemas.rng import derive, rng
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.simulation.world.home import Home

HOURS = (9.0, 21.5, 12.0, 16.5, 7.5, 22.0, 14.0, 18.5)
"""Hours of the day, one after the other."""

LONGEST = 16
"""Steps of the programs from which is chosen."""

TRIED = 24
"""Programs that are tried in a home."""


class Pictured(NamedTuple):
    """One step of the gallery.

    Attributes:
        home: name of the home.
        hour: of the day.
        title: of the program.
        step: with nodes.
        picture: (H, W, 3).
        shown: whether person and object can be recognised.
    """

    home: str
    hour: float
    title: str
    step: Step
    picture: Image
    shown: bool


def homes(knowledge: Knowledge, seed: int) -> Iterator[tuple[str, EnvironmentGraph]]:
    """Our homes, and then generated ones."""
    for name in library.names():
        yield name, library.load_graph(name, knowledge)
    for number in range(1000):
        try:
            layout = generate(3 + number % 5, derive(seed, "gallery", number) % 10_000, knowledge)
        except HearthError:
            continue
        yield f"generated {number + 1}", scene(layout, knowledge)


def gallery(
    programs: Sequence[Program], knowledge: Knowledge, count: int = 24, seed: int = 0,
    size: tuple[int, int] = (320, 240), quality: str = "draft",
) -> Iterator[Pictured]:  # fmt: skip
    """Yield steps in as many homes.

    Args:
        programs: from which steps are chosen.
        knowledge: of their classes.
        count: of steps.
        seed: decides programs, people, generated homes and looks.
        size: of a picture, pixels.
        quality: as in `modalities.render`.
    """
    short = [program for program in programs if len(program.steps) <= LONGEST]
    rng(seed, "gallery", "").shuffle(short)
    waiting = cycle(short)
    done: Counter[str] = Counter()
    for number, (name, graph) in enumerate(islice(homes(knowledge, seed), count)):
        found = _pictured(name, graph, islice(waiting, TRIED), knowledge, done, number, seed, size, quality)
        if found is not None:
            done[found.step.action] += 1
            yield found


def _pictured(
    name: str, graph: EnvironmentGraph, programs: Iterator[Program], knowledge: Knowledge, done: Counter[str],
    number: int, seed: int, size: tuple[int, int], quality: str,
) -> Pictured | None:  # fmt: skip
    """Return the step of some programs that is most worth a picture in a home: of an action that was shown least."""
    place, hour = Home.from_graph(graph, name, knowledge), HOURS[number % len(HOURS)]
    best: Pictured | None = None
    for program in programs:
        trial = attempt(program, place, seed)
        if isinstance(trial, Failure) or not trial.execution.executable:
            continue
        ticks = list(trial.execution.program.ticks())
        chosen = min(range(len(ticks)), key=lambda k: (_rank(ticks[k][0], done), k))
        if best is not None and best.shown and _rank(ticks[chosen][0], done) >= _rank(best.step, done):
            continue
        trajectory = trajectory_of(trial.execution, graph, knowledge, seed=derive(seed, number), hour=hour)
        picture, shown = picture_of(trajectory, trajectory.keyframes[chosen + 1], graph, size, quality)
        if shown or best is None or not best.shown:
            best = Pictured(name, hour, program.title, ticks[chosen][0], picture, shown)
        if shown and not done[best.step.action]:
            break
    return best


def _rank(step: Step, done: Counter[str]) -> tuple[int, bool]:
    """Return how little a step adds to a gallery: its action was shown, or moves no hand."""
    gesture = gesture_of(step)
    return done[step.action], not (gesture.hand or gesture.rests)


def picture_of(
    trajectory: Trajectory, keyframe: Keyframe, graph: EnvironmentGraph, size: tuple[int, int], quality: str = "draft"
) -> tuple[Image, bool]:
    """Return a picture of a step from its best camera, and whether person and object can be recognized in it."""
    rooms = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY}
    named = tuple(dict.fromkeys(seen_as(node, keyframe.places) for node in named_nodes(keyframe.steps, rooms)))
    actor = keyframe.acting
    camera = best_view(keyframe.scene, room_views(graph, *size), actor, named, rooms.get(actor.room))
    shot = shoot(keyframe.scene, camera, by_rays=quality == "fine")
    picture: Image = pictures_of(shot, ["rgb"], quality)["rgb"]
    return picture, shows(shot, actor.node.id, named)
