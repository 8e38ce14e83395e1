"""A program run in a home before it is submitted: the changes of each step, and the character's places."""

from functools import lru_cache
from importlib.resources import files
from typing import Any

import orjson

from hearth.datasets.report.floor_plan_svg import draw
from hearth.grounding.grounded_run import Trial, attempt
from hearth.homes import library
from hearth.kb.knowledge import Knowledge
from hearth.schemas.failures import Code, Failure
from hearth.schemas.optional_libraries import library as library_of
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program
from hearth.simulation.motion.base_pose import hand_and_base_poses
from hearth.simulation.motion.positions import placed
from hearth.simulation.world.home import Home
from hearth.simulation.world.pose import Pose
from hearth.web.annotate.change_words import changed_in_words, placed_in_words
from hearth.web.annotate.fault_words import PART, stop_in_words
from hearth.web.annotate.program_draft import SPECIAL, Draft
from hearth.web.phrases import say
from hearth.web.web_errors import WebError


def homes() -> tuple[str, ...]:
    """Return the names of our homes."""
    return library.names()


@lru_cache(maxsize=8)
def home_of(name: str, known: Knowledge) -> Home:
    """Return a home of ours.

    Raises:
        WebError: UNKNOWN_HOME.
    """
    if name not in homes():
        raise WebError(Code.UNKNOWN_HOME, "home", ", ".join(homes()), name[:40])
    return Home.from_graph(library.load_graph(name, known), name, known)


@lru_cache(maxsize=8)
def plan_of(name: str, known: Knowledge) -> str:
    """Return the floor plan of a home as SVG, in metres; z points up the page."""
    return draw(library.load_graph(name, known).nodes)


def run_draft(draft: Draft, title: str, home: str, known: Knowledge) -> dict[str, Any]:
    """Run a draft in a home, special blocks left out.

    Args:
        draft: without faults.
        title: of the activity, from which the random choices of the environment follow.
        home: the name of the home.
        known: the knowledge.

    Returns:
        `home`, `ran` (whether all steps ran), `why` and `step` (from 0) of the failure, and `ticks`: for each step done
        its number, line, changes in words, and where the character is: (x, z) in metres, yaw in degrees. `left` has the
        numbers of the special blocks before the end of the run, `added` says what was put where for it.
    """
    numbers, lines = _lines(draft)
    trial = _trial(lines, title, home, known)
    if isinstance(trial, Failure):
        at = numbers[trial.tick] if trial.tick < len(numbers) else -1
        why = stop_in_words(trial, numbers, draft, known)
        return {"home": home, "ran": False, "why": why, "step": at, "ticks": [], "start": None, "left": []}
    found = _reported(trial, numbers, lines)
    why = stop_in_words(trial.execution.failure, numbers, draft, known) if trial.execution.failure else ""
    end = found["step"] if found["step"] >= 0 else len(draft.blocks)
    left = [number for number in range(end) if draft.blocks[number].action == SPECIAL]
    return {"home": home, **found, "why": why, "left": left}


def replay_draft(draft: Draft, title: str, home: str, known: Knowledge) -> dict[str, Any]:
    """Return the same run in 3D, for `replay.js` of the report: `home`, the address of the home's shapes, and `run`.

    Raises:
        WebError: NOT_RENDERED: nothing of it runs.
        HearthError: MISSING_FILE: libraries for pictures are not installed.
    """
    from hearth.rendering.film.replay_3d import run_shapes

    library_of("trimesh")
    numbers, lines = _lines(draft)
    trial = _trial(lines, title, home, known)
    if isinstance(trial, Failure):
        why = stop_in_words(trial, numbers, draft, known)
        raise WebError(Code.NOT_RENDERED, "home", "a program that begins to run there", why)
    graph = library.load_graph(home, known)
    return {"home": f"/annotate/shapes/{home}", "run": run_shapes(trial.execution, graph, known)}


@lru_cache(maxsize=8)
def shapes_of(name: str, known: Knowledge) -> bytes:
    """Return the shapes of a home, as JSON.

    Raises:
        WebError: UNKNOWN_HOME.
    """
    from hearth.rendering.film.replay_3d import home_shapes

    home_of(name, known)
    return orjson.dumps(home_shapes(library.load_graph(name, known), known))


def replay_script() -> bytes:
    """Return the script that plays runs in 3D, which reports have, too."""
    return (files("hearth.datasets.report") / "assets" / "replay.js").read_bytes()


def _lines(draft: Draft) -> tuple[list[int], list[str]]:
    """Return the blocks that run, by number and as lines of a program."""
    numbers = [number for number, block in enumerate(draft.blocks) if block.action != SPECIAL]
    return numbers, [draft.blocks[number].line() for number in numbers]


def _trial(lines: list[str], title: str, home: str, known: Knowledge) -> Trial | Failure:
    program, _ = parse_program("\n".join(lines) + "\n")
    return attempt(Program(title, "", program.steps), home_of(home, known))


def _reported(trial: Trial, numbers: list[int], lines: list[str]) -> dict[str, Any]:
    worlds, failure = trial.execution.worlds, trial.execution.failure
    poses = [tick[0].pose if tick else None for tick in hand_and_base_poses(trial.execution)]
    ticks = [
        {
            "step": numbers[tick],
            "line": lines[tick],
            "changes": changed_in_words(worlds[tick + 1].changes(worlds[tick]), worlds[tick]) or say(PART, "no_change"),
            "at": _where(poses[tick] if tick < len(poses) else None),
        }
        for tick in range(len(worlds) - 1)
    ]
    at = numbers[failure.tick] if failure and failure.tick < len(numbers) else -1
    start = _where(placed(worlds[0]).agents[0].pose)
    added = _added(trial)
    return {"ran": not failure, "step": at, "ticks": ticks, "start": start, "added": added}


def _added(trial: Trial) -> str:
    """Return what was put where for a run, of the things that its program names; "" for a home as it is."""
    made = trial.environment
    if made is None:
        return ""
    named = {ref.node for ref in made.program.objects() if ref.node is not None}
    where = placed_in_words(made.added, named, made.world)
    return say(PART, "added", things=where) if where else say(PART, "prepared")


def _where(pose: Pose | None) -> list[float] | None:
    """Return where the character stands, in metres and degrees; None in homes without geometry."""
    return None if pose is None else [round(pose.x, 2), round(pose.z, 2), round(pose.yaw)]
