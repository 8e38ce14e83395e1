"""Programs that bring one hazard each (`planted.yaml`), run by action set 3, and the hazards that are found."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import yaml
from recipes.recipe_runs import KNOWN, Recipe, home, program_of

from hearth.grounding.grounded_run import LEAST, attempt
from hearth.homes import library
from hearth.schemas.failure_words import why
from hearth.schemas.failures import Failure
from hearth.schemas.program import ObjectRef, Program
from hearth.simulation.hazards import hazards
from hearth.simulation.rules import CONSEQUENCES

_WAITS = re.compile(r"WAIT(\d+)\.")


class Plant(NamedTuple):
    """A program with a hazard.

    Attributes:
        story: what happens.
        hazard: the row of `hazards.yaml` that names it.
        thing: a class that it names.
        steps: sentences, one step each.
    """

    story: str
    hazard: str
    thing: str
    steps: tuple[str, ...]


def plants() -> Iterator[Plant]:
    """Yield every planted hazard; `WAIT10.` stands for ten sentences `Wait.`"""
    rows = yaml.safe_load((Path(__file__).parent / "planted.yaml").read_text(encoding="utf-8"))
    for story, row in rows.items():
        text = _WAITS.sub(lambda found: "Wait. " * int(found[1]), row["steps"])
        steps = tuple(each.strip() for each in text.split(".") if each.strip())
        yield Plant(story, row["hazard"], row["where"], steps)


def found_in(plant: Plant, name: str) -> set[str]:
    """Return the rows that name the planted thing as a hazard in a home.

    Raises:
        ValueError: the program does not run.
    """
    program = program_of(Recipe(plant.story, (), plant.steps, ""))
    trial = attempt(program, home(name), 0, CONSEQUENCES, size=LEAST)
    if isinstance(trial, Failure):
        raise ValueError(f"{plant.story}: {why(trial)}")
    if trial.execution.failure is not None:
        raise ValueError(f"{plant.story}: {why(trial.execution.failure)}")
    named = dict(zip((r.name for r in refs(program)), (r.node for r in refs(trial.execution.program)), strict=True))
    wanted = named[KNOWN.object_class(plant.thing).name]
    return {each.hazard.name for each in hazards(trial.execution) if wanted in each.things}


def refs(program: Program) -> list[ObjectRef]:
    """Return the objects of a program, step by step."""
    return [ref for step in program.steps for ref in step.objects]


def main() -> None:
    """Print how many of the planted hazards are found, and those that are not."""
    every = tuple(plants())
    number, ran = 0, 0
    for n, plant in enumerate(every):
        name = library.names()[n % len(library.names())]
        try:
            found = plant.hazard in found_in(plant, name)
        except ValueError as error:
            print("does not run:", name, error)
            continue
        ran += 1
        number += found
        if not found:
            print(f"not found: {plant.hazard} ({plant.story}) in {name}; found {sorted(found_in(plant, name))}")
    print(f"{number} of {ran} planted hazards are found: recall {number / ran:.3f}; {len(every) - ran} do not run")


if __name__ == "__main__":
    main()
