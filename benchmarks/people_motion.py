"""Measure how people move: `python benchmarks/people_motion.py [--pairs 300] [--seed 0] [--json FILE]`.

Executable programs of our corpus are drawn by the seed, each in the next of the seven homes, and filmed without
pictures, at ten poses a second. Printed are: how fast feet on the floor slide; how fast heads move; how often a body, a
hand or a thing jumps; how often bodies and arms are in solids; how far held things are from the palm that holds them.

An ankle or a tip of toes is on the floor if it is as low as when standing, within 6 mm, in both of two poses. A jump is
a displacement between two poses that differs from the one before by more than 15 cm; of a thing, twice that. A joint is
in a solid if four of five rays from it leave its surfaces more often than they enter; the middle of a trunk, thigh or
shin is at least 5 cm below its skin. What is sat or lain on, held, worn, soft or hung is not counted.
"""

from __future__ import annotations

import argparse
import json
import time
from collections import Counter
from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from hearth.analysis.programs_in_homes import Script, scripts
from hearth.commands import inputs
from hearth.grounding.grounded_run import attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.rendering.film.execution_keyframes import Trajectory, trajectory_of
from hearth.rendering.people.action_poses import Actor
from hearth.rendering.people.motion import Frame, frames
from hearth.rendering.rays.ray_casting import Caster
from hearth.rendering.scene.instances import Thing, placed
from hearth.schemas.failures import Failure
from hearth.schemas.optional_libraries import library as loaded
from hearth.schemas.rng import rng
from hearth.simulation.world.home import Home

POSES = 10.0
"""A second."""
JUMP = 0.15
LIFTED = 0.006
"""Metres by which the ankle or toe of a lifted foot is above where it is when standing."""
SOLE = 0.012
"""Height of the tip of the toes of who stands, as a share of the body's."""
SOFT = (
    "curtain",
    "blinds",
    "pillow",
    "duvet",
    "blanket",
    "comforter",
    "sheets",
    "towel",
    "carpet",
    "mat",
    "rug",
    "clothes",
    "plant",
)
"""Parts of the names of classes that give way or hang."""
TRUNK = ("pelvis", "spine", "chest", "neck", "head", "hip", "knee")
ARM = ("elbow", "wrist")
WAYS = np.array(
    ((0.31, 0.13, 0.94), (-0.87, 0.21, 0.45), (0.42, 0.17, -0.89), (-0.51, -0.23, -0.83), (0.77, 0.55, 0.32)),
    np.float32,
)
"""Directions of rays, none along the walls."""
MOST = 4
"""Rays that must agree: the library drops one of two surfaces that coincide."""


class Found(NamedTuple):
    """Measurements of the films of some pairs."""

    sliding: list[float]
    heads: list[float]
    jumps: Counter[str]
    body: list[bool]
    arms: list[bool]
    held: list[float]
    places: Counter[str]


def drawn(pairs: int, seed: int) -> Iterator[tuple[str, Trajectory]]:
    """Trajectories of programs drawn by the seed, each in the next home."""
    known, names = default(), library.names()
    read = [script.program for script in scripts(inputs.paths([]), known) if isinstance(script, Script)]
    rng(seed, "people_motion", "").shuffle(read)
    done = 0
    for number in range(pairs * 4):
        name, program = names[number % len(names)], read[number % len(read)]
        graph = library.load_graph(name, known)
        trial = attempt(program, Home.from_graph(graph, name, known), seed)
        if isinstance(trial, Failure) or not trial.execution.executable:
            continue
        yield f"{name}: {program.title}", trajectory_of(trial.execution, graph, known, seed=seed + done)
        done += 1
        if done == pairs:
            return


def measured(trajectory: Trajectory, found: Found) -> None:
    """Add what one film shows."""
    shown = list(frames(trajectory, POSES))
    for number in range(len(shown[0].actors)):
        _moving([frame.actors[number] for frame in shown], found)
    _things(shown, found)
    for tick, group in groupby(shown, key=lambda frame: frame.tick):
        _solids(trajectory, tick, list(group), found)


def _moving(actors: list[Actor], found: Found) -> None:
    points = [_world(actor) for actor in actors]
    for one, two, a, b in zip(actors, actors[1:], points, points[1:], strict=False):
        found.heads.append(float(np.linalg.norm(b["head"] - a["head"])) * POSES)
        for side in "rl":
            lying = "lying" in (one.body_pose.posture, two.body_pose.posture)
            own = one.body.proportions
            on_floor = (("ankle", own.ankle), ("toe", SOLE * own.height))
            for name, rest in on_floor if not lying else ():
                start, end = a[f"{name}_{side}"], b[f"{name}_{side}"]
                if max(start[1], end[1]) < one.level + rest + LIFTED:
                    found.sliding.append(float(np.hypot(*(end - start)[[0, 2]])) * POSES)
    for a, b, c in zip(points, points[1:], points[2:], strict=False):
        for name in ("head", "pelvis", "hand_r", "hand_l"):
            found.jumps[name.split("_")[0]] += bool(np.linalg.norm(c[name] - 2 * b[name] + a[name]) > JUMP)
        found.jumps["poses"] += 1


def _world(actor: Actor) -> dict[str, NDArray[np.float64]]:
    return {name: np.array(actor.world(tuple(map(float, at)))) for name, at in actor.figure().joints().items()}


def _things(shown: list[Frame], found: Found) -> None:
    """Jumps of things, between poses, and the distance of held things from their palms."""
    before: dict[int, NDArray[np.float64]] = {}
    seen: set[Thing] = set()
    for frame in shown:
        people = {actor.node.id for actor in frame.actors}
        # What flows from a held thing has its id, and comes after it.
        first = {thing.id: thing for thing in reversed(frame.scene.things) if thing.id not in people}
        new = {*first.values()} - seen
        seen |= new
        for thing in new:
            at = np.array(thing.position)
            if thing.id in before and np.linalg.norm(at - before[thing.id]) > 2 * JUMP:
                found.jumps["thing"] += 1
                found.places[f"jump {thing.class_name}"] += 1
        before |= {number: np.array(thing.position) for number, thing in first.items()}
        for actor in frame.actors:
            _held(frame, actor, found)


def _held(frame: Frame, actor: Actor, found: Found) -> None:
    for node, side in frame.holds.get(actor.node.id, {}).items():
        thing = next((thing for thing in frame.scene.things if thing.id == node), None)
        if thing is not None:
            far = float(_caster(thing).compute_distance(_tensor(np.array([actor.hand(side)])))[0].item())
            found.held.append(far)
            if far > 0.03:
                found.places[f"held {thing.class_name}"] += 1


_KNOWN: dict[Thing, Any] = {}


def _caster(thing: Thing) -> Any:
    if len(_KNOWN) > 64:
        _KNOWN.clear()
    if thing not in _KNOWN:
        _KNOWN[thing] = Caster.of(placed(thing).corners).scene
    return _KNOWN[thing]


def _tensor(array: NDArray[Any]) -> Any:
    return loaded("open3d").core.Tensor(np.ascontiguousarray(array, np.float32))


def _solids(trajectory: Trajectory, tick: int, shown: list[Frame], found: Found) -> None:
    """Return the joints of a tick's poses that are in solids."""
    scene = trajectory.keyframes[min(tick, len(trajectory.keyframes) - 1)].scene
    apart = {actor.node.id for frame in shown for actor in frame.actors}
    apart |= {actor.place for frame in shown for actor in frame.actors}
    apart |= {node for frame in shown for holds in frame.holds.values() for node in holds}
    things = [*scene.things, *scene.static.things]
    solid = [t for t in things if t.id not in apart and not any(part in t.class_name for part in SOFT)]
    names, points = [], []
    for frame in shown:
        for actor in frame.actors:
            at = _world(actor)
            for name in (*TRUNK, *ARM):
                for side in ("",) if name in at else ("_r", "_l"):
                    names.append(name in ARM)
                    points.append(at[name + side])
    if not points:
        return
    # What a point is inside of has a box that the point is inside of.
    near = [k for k, thing in enumerate(solid) if _reaches(thing, np.array(points))]
    corners = np.concatenate([placed(solid[k]).corners for k in near]) if near else np.zeros((0, 3, 3), np.float32)
    owners = np.repeat(np.array(near, np.int64), [len(placed(solid[k])) for k in near])
    number = np.array(points).shape[0] // sum(len(frame.actors) for frame in shown)
    inside = _inside(corners, owners, np.array(points, np.float32))
    for row, arms in zip(inside.reshape(-1, number), np.array(names).reshape(-1, number), strict=True):
        for part, kind, into in ((~arms, "body", found.body), (arms, "arm", found.arms)):
            within = row[part & (row >= 0)]
            into.append(len(within) > 0)
            for owner in within[:1]:
                found.places[f"{kind} in {solid[owner].class_name}"] += 1


@lru_cache(maxsize=4096)
def _extent(thing: Thing) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    low, high = placed(thing).bounds()
    return low - 1e-3, high + 1e-3


def _reaches(thing: Thing, points: NDArray[Any]) -> bool:
    """Return whether a thing's box contains any of some points."""
    low, high = _extent(thing)
    return bool(((points >= low) & (points <= high)).all(axis=1).any())


def _inside(corners: NDArray[Any], owners: NDArray[Any], points: NDArray[Any]) -> NDArray[np.int64]:
    """The thing whose surfaces most rays from each point leave more often than they enter; -1 for none."""
    if not len(corners):
        return np.full(len(points), -1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    scene, count = Caster.of(corners).scene, int(owners.max()) + 1
    votes: Counter[int] = Counter()
    for way in WAYS:
        rays = np.concatenate([points, np.tile(way, (len(points), 1))], axis=1)
        hits = {name: value.numpy() for name, value in scene.list_intersections(_tensor(rays)).items()}
        triangle = hits["primitive_ids"].astype(np.int64)
        keys = hits["ray_ids"].astype(np.int64) * count + owners[triangle]
        known, of = np.unique(keys, return_inverse=True)
        wound = np.bincount(of, np.sign(normals[triangle] @ way), len(known))
        votes.update(known[wound > 0.5].tolist())
    found = np.full(len(points), -1)
    for key, number in votes.items():
        if number >= MOST:
            found[key // count] = key % count
    return found


def main() -> None:
    """Measure, print, and write the file of `--json`."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--pairs", type=int, default=300)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--json", type=Path)
    options.add_argument("--minutes", type=float, default=1e9, help="after which no further pair is begun")
    options.add_argument("--worst", type=int, default=12, help="number of most frequent faults to print")
    chosen = options.parse_args()
    found = Found([], [], Counter(), [], [], [], Counter())
    count = 0
    began = time.perf_counter()
    for _, trajectory in drawn(chosen.pairs, chosen.seed):
        measured(trajectory, found)
        count += 1
        if time.perf_counter() - began > 60 * chosen.minutes:
            break
    figures = summary(found, count)
    for name, value in figures.items():
        print(f"{name:44} {value:.4g}")
    for name, times in found.places.most_common(chosen.worst):
        print(f"{times:8} {name}")
    if chosen.json:
        chosen.json.write_text(json.dumps(figures, indent=1) + "\n", "utf-8")


def summary(found: Found, pairs: int) -> dict[str, float]:
    """The figures by name."""
    far = found.held or [float("nan")]
    poses = max(found.jumps["poses"], 1)
    return {
        "pairs": pairs,
        "poses": poses,
        "foot sliding, median, cm/s": float(np.median(found.sliding)) * 100,
        "foot sliding, 95th percentile, cm/s": float(np.percentile(found.sliding, 95)) * 100,
        "head speed, max, m/s": max(found.heads),
        "jumps of heads and hips": found.jumps["head"] + found.jumps["pelvis"],
        "jumps of hands": found.jumps["hand"],
        "jumps of things": found.jumps["thing"],
        "bodies in solids, % of poses": 100 * float(np.mean(found.body)),
        "arms in solids, % of poses": 100 * float(np.mean(found.arms)),
        "held things, median cm from the palm": 100 * float(np.median(far)),
        "held things, 95th percentile cm": 100 * float(np.percentile(far, 95)),
        "held things, % within 3 cm": 100 * float(np.mean(np.array(far) <= 0.03)),
    }


if __name__ == "__main__":
    main()
