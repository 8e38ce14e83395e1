"""Recipes as people write them (the YAML files here), run by action set 3 in each home and held to their goals."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import yaml

from hearth.grounding.grounded_run import LEAST, attempt
from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.pipelines.readers.plans_in_words import parse_steps
from hearth.schemas.failure_words import why
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home

HERE = Path(__file__).parent
KNOWN = default().of_set(3)


class Recipe(NamedTuple):
    """A recipe.

    Attributes:
        title: its name.
        ingredients: as on a shopping list; the names of classes.
        steps: sentences, one step each.
        goal: what is so at the end.
    """

    title: str
    ingredients: tuple[str, ...]
    steps: tuple[str, ...]
    goal: str

    @property
    def text(self) -> str:
        """The plan as numbered lines."""
        return "\n".join([self.title, *(f"{number}. {step}" for number, step in enumerate(self.steps, 1))])


def recipes() -> Iterator[Recipe]:
    """Yield every recipe, file by file."""
    for file in sorted(HERE.glob("*.yaml")):
        for title, row in yaml.safe_load(file.read_text(encoding="utf-8")).items():
            steps = tuple(each.strip() for each in row["steps"].split(".") if each.strip())
            yield Recipe(title, tuple(row["ingredients"].split(", ")), steps, row["goal"])


def program_of(recipe: Recipe) -> Program:
    """Return the program of a recipe.

    Raises:
        ValueError: a sentence is not understood, or only in part.
    """
    found = parse_steps(recipe.text, KNOWN)
    for said in (*found.faults, *found.warnings):
        raise ValueError(f"{recipe.title}, line {said.line}: {said.message} ({said.found})")
    return found.program


@lru_cache(maxsize=8)
def home(name: str) -> Home:
    """Return a home of the library with the knowledge of set 3."""
    return Home.from_graph(library.load_graph(name, KNOWN), name, KNOWN)


def outcome(recipe: Recipe, program: Program, name: str) -> str:
    """Return why a recipe does not end in its goal in a home; '' if it does."""
    trial = attempt(program, home(name), 0, CONSEQUENCES, size=LEAST)
    if isinstance(trial, Failure):
        return f"not placed: {trial.code} {why(trial)}"
    execution = trial.execution
    if execution.failure is not None:
        return f"step {execution.failure.tick + 1} failed: {why(execution.failure)}"
    progress = Progress.of(read_goal(recipe.goal, execution.worlds[0].home), execution)
    return "" if progress.satisfied else f"not reached: {progress.unmet()}"


def main() -> None:
    """Print how many recipes run and end in their goals, and those that do not in at least six homes."""
    good = whole = 0
    every = tuple(recipes())
    for recipe in every:
        try:
            program = program_of(recipe)
        except ValueError as error:
            print("READ", error)
            continue
        found = {name: outcome(recipe, program, name) for name in library.names()}
        reached = sum(not words for words in found.values())
        good += reached >= 6
        whole += reached == len(found)
        if reached < len(found):
            print(f"{recipe.title}: {reached} of {len(found)} homes")
            for words in dict.fromkeys(filter(None, found.values())):
                print("    ", ", ".join(name for name in found if found[name] == words), words)
    print(f"{good} of {len(every)} recipes reach their goal in at least six homes, {whole} in all seven")


if __name__ == "__main__":
    main()
