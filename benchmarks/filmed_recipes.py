"""Films of the household recipes of `tests/recipes`, as sheets of frames to be looked at.

    python benchmarks/filmed_recipes.py OUT [--films 40] [--seed 1] [--only "Fried egg,Iron a shirt"]

Recipes are drawn by a seed, sampled, run and filmed in our homes in turn. A row of a sheet is a film by its own camera:
a frame of each of its last acts besides walks, one of a row of waits, and its end. OUT has a sheet of every five films.
"""

from __future__ import annotations

import argparse
import random
from itertools import groupby
from pathlib import Path

import benchmark_cases
import numpy as np

from hearth.grounding.grounded_run import LEAST, Trial, attempt
from hearth.homes import library
from hearth.rendering.arrays import Image
from hearth.rendering.film.contact_sheet import contact_sheet
from hearth.rendering.film.execution_keyframes import trajectory_of
from hearth.rendering.film.png import encode
from hearth.rendering.film.video import AUTO, CameraSelector
from hearth.rendering.modalities import pictures_of
from hearth.rendering.people.motion import frames, spans
from hearth.rendering.rays.camera_shot import shoot
from hearth.schemas.syntax import print_step
from hearth.simulation.rules import CONSEQUENCES

assert benchmark_cases  # it puts the tests on the path
from recipes.recipe_runs import KNOWN, Recipe, home, program_of, recipes  # noqa: E402

SIZE = (256, 192)
FRAMES, FILMS, RATE = 7, 5, 10.0
WALKS = frozenset({"Walk", "Find", "Run", "TurnTo", "LookAt"})


def film_row(recipe: Recipe, place: str) -> Image:
    """Return frames of a recipe's film side by side."""
    trial = attempt(program_of(recipe), home(place), 0, CONSEQUENCES, size=LEAST)
    assert isinstance(trial, Trial) and trial.execution.executable, (recipe.title, place)
    graph = library.load_graph(place, KNOWN)
    trajectory = trajectory_of(trial.execution, graph, KNOWN, seed=3)
    found = spans(trajectory)
    done = [span for span in found if span.steps and not {step.action for step in span.steps} & WALKS]
    acts = [last for _, (*_, last) in groupby(done, lambda span: span.steps)][1 - FRAMES :]
    taken = list(frames(trajectory, RATE))
    times = [span.start + 0.6 * (span.end - span.start) for span in acts]
    selector = CameraSelector(trajectory, graph, AUTO, SIZE)
    shown = []
    for time in (*times, found[-1].end):
        frame = min(taken, key=lambda each: abs(each.time - time))
        picture = pictures_of(shoot(frame.scene, selector.camera(frame)), ["rgb"])["rgb"]
        shown.append((picture, " ".join(map(print_step, frame.steps))))
    shown[-1] = (shown[-1][0], "end")
    blank = np.full_like(shown[0][0], 255)
    shown += [(blank, "")] * (FRAMES - len(shown))
    return contact_sheet(shown, f"{recipe.title} ({place})", columns=FRAMES)


def main() -> None:
    """Write the sheets."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("out", type=Path)
    options.add_argument("--films", type=int, default=40)
    options.add_argument("--seed", type=int, default=1)
    options.add_argument("--only", default="", help="titles, separated by commas")
    asked = options.parse_args()
    every = list(recipes())
    only = {title.strip() for title in asked.only.split(",") if title.strip()}
    drawn = random.Random(asked.seed).sample(every, min(asked.films, len(every)))
    names = library.names()
    chosen = [(recipe, names[n % len(names)]) for n, recipe in enumerate(drawn)]
    chosen = [pair for pair in chosen if not only or pair[0].title in only]
    asked.out.mkdir(parents=True, exist_ok=True)
    for start in range(0, len(chosen), FILMS):
        rows = [film_row(recipe, place) for recipe, place in chosen[start : start + FILMS]]
        (asked.out / f"sheet_{start // FILMS + 1}.png").write_bytes(encode(np.concatenate(rows)))
        print(", ".join(recipe.title for recipe, _ in chosen[start : start + FILMS]), flush=True)


if __name__ == "__main__":
    main()
