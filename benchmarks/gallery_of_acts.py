"""A gallery of the 84 actions of set 3, and a quiz of it: a strip of pictures and eight names each, answers apart.

    python benchmarks/gallery_of_acts.py OUT [--only Dance,Jump] [--seed 1]

Each action is the last step of a short program (`gallery_of_acts.yaml`), which is sampled, run and filmed in a home.
The strip has a moment before the act, three while, and one after, by the camera near the person that shows it best.
OUT/quiz has the strips under numbers and `choices.json`; OUT/answers.json says which action each is.
"""

from __future__ import annotations

import argparse
import json
import random
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import yaml

from hearth.grounding.grounded_run import LEAST, Trial, as_given, attempt
from hearth.homes import library
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.rendering.arrays import Image
from hearth.rendering.cameras.camera import Camera, follow
from hearth.rendering.cameras.camera_candidates import around, free, preference
from hearth.rendering.cameras.recognition import recognition
from hearth.rendering.cameras.viewpoints import best_view, room_views
from hearth.rendering.cameras.visibility_estimates import Obstacles, person, values
from hearth.rendering.film.contact_sheet import contact_sheet
from hearth.rendering.film.execution_keyframes import named_nodes, trajectory_of
from hearth.rendering.film.film_moments import room_at
from hearth.rendering.film.png import encode
from hearth.rendering.modalities import pictures_of
from hearth.rendering.people.motion import Frame, frames, spans
from hearth.rendering.rays.camera_shot import shoot
from hearth.schemas.graph import Box, EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_steps
from hearth.schemas.vocabulary import ROOM_CATEGORY
from hearth.simulation.engine import Execution
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home

ROWS = Path(__file__).with_name("gallery_of_acts.yaml")
HOME = "maple"
SIZE = (360, 270)
RATE = 10.0
NAMES = 8
WIDE = frozenset({"Jump", "Dance", "Turnleft", "Turnright", "Walkforward"})
"""Acts that need all of the person in the picture."""

KNOWN = default().of_set(3)


def program_of(text: str) -> Program:
    """Return a program of `Walk book; Grab book`."""
    lines = []
    for each in text.split("; "):
        action, *names = each.split()
        lines.append(f"[{action}]" + "".join(f" <{name}> (1)" for name in names))
    program, faults = check(Program(steps=tuple(step for line in lines for step in parse_steps(line))), KNOWN)
    assert not faults, (text, faults)
    return program


def execution_of(text: str, graph: EnvironmentGraph) -> Execution:
    """Return the run of a program in a home made for it, or in the home as it is if it walks by metres."""
    program, home = program_of(text), Home.from_graph(graph, HOME, KNOWN)
    by_metres = any(step.action == "Walkforward" for step in program.steps)
    how = as_given(program, home, 0, CONSEQUENCES) if by_metres else None
    trial = how or attempt(program, home, 0, CONSEQUENCES, size=LEAST)
    assert isinstance(trial, Trial), (text, trial)
    assert trial.execution.executable, (text, trial.execution.failure)
    return trial.execution


def strip(text: str, graph: EnvironmentGraph, fine: bool) -> Image:
    """Return five pictures of a program's last step, side by side."""
    execution = execution_of(text, graph)
    trajectory = trajectory_of(execution, graph, KNOWN, seed=3)
    last = spans(trajectory)[-1]
    taken = [frame for frame in frames(trajectory, RATE) if frame.time >= last.start - 0.3]
    moments = _moments(taken, last.start, last.end)
    rooms = {node.id: node.box for node in graph.nodes if node.category == ROOM_CATEGORY and node.box}
    views = room_views(graph, *SIZE)
    middle = moments[len(moments) // 2]
    named = [node for node in named_nodes(middle.steps, rooms) if node != middle.actors[0].node.id]

    def camera_of(frame: Frame) -> Camera:
        actor = frame.actors[0]
        room = rooms.get(room_at(rooms, actor.spot))
        wide = not named and frame.steps and frame.steps[0].action in WIDE
        return whole_person(frame, room) if wide else best_view(frame.scene, views, actor, named, room)

    shown, usual = [], camera_of(middle)
    for frame in moments:
        camera = usual
        if recognition(shoot(frame.scene, camera), frame.actors[0].node.id).share < 0.02:
            camera = camera_of(frame)
        how = (
            (shoot(frame.scene, camera, by_rays=True), ["rgb"], "fine")
            if fine
            else (shoot(frame.scene, camera), ["rgb"])
        )
        shown.append((pictures_of(*how)["rgb"], ""))
    return contact_sheet(shown, columns=len(shown))


def whole_person(frame: Frame, room: Box | None) -> Camera:
    """Return the camera that shows all of the person, from its front if possible."""
    actor = frame.actors[0]
    who, obstacles = person(actor), Obstacles.exact(frame.scene)
    cameras, loss = free(around(actor, who, [], room, SIZE, "near"), obstacles)
    if not cameras:
        return follow("follow", actor.position, actor.yaw, *SIZE)
    worth = (values(cameras, who, [], obstacles).total - loss) * preference(cameras, actor)
    wide = cameras[int(worth.argmax())]
    return replace(wide, fov=min(wide.fov * 1.15, 100.0))


def _moments(taken: list[Frame], start: float, end: float) -> list[Frame]:
    """Return five frames: before the act, at three moments of it, and after it."""
    times = [start - 0.1, *(start + part * (end - start) for part in (0.35, 0.56, 0.76)), end]
    return [min(taken, key=lambda frame: abs(frame.time - time)) for time in times]


def names_for(action: str, chooser: random.Random) -> list[str]:
    """Return eight names, the right one among them."""
    others = chooser.sample(sorted(set(KNOWN.actions) - {action}), NAMES - 1)
    names = [action, *others]
    chooser.shuffle(names)
    return names


def made(rows: Mapping[str, str], out: Path, seed: int, fine: bool) -> None:
    """Write the strips, the choices and the answers."""
    (out / "quiz").mkdir(parents=True, exist_ok=True)
    graph = library.load_graph(HOME, KNOWN)
    order = sorted(KNOWN.actions)
    random.Random(seed).shuffle(order)
    choices: dict[str, list[str]] = {}
    answers: dict[str, Any] = {}
    for number, action in enumerate(order, 1):
        name = f"{number:02}"
        choices[name] = names_for(action, random.Random(f"{seed} {action}"))
        answers[name] = action
        if action in rows:
            (out / "quiz" / f"{name}.png").write_bytes(encode(strip(rows[action], graph, fine)))
            print(f"{name} {action}", flush=True)
    (out / "quiz" / "choices.json").write_text(json.dumps(choices, indent=1) + "\n", encoding="utf-8")
    (out / "answers.json").write_text(json.dumps(answers, indent=1) + "\n", encoding="utf-8")


def main() -> None:
    """Make the gallery."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("out", type=Path)
    options.add_argument("--only", default="", help="actions, separated by commas")
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--fine", action="store_true", help="smooth edges and soft shadows; four times slower")
    asked = options.parse_args()
    rows: dict[str, str] = yaml.safe_load(ROWS.read_text(encoding="utf-8"))
    only = {name for name in asked.only.split(",") if name}
    made({name: text for name, text in rows.items() if not only or name in only}, asked.out, asked.seed, asked.fine)


if __name__ == "__main__":
    main()
