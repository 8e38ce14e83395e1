"""Perturbations, repairs and sketches of programs stay as they are until somebody means to change them."""

from __future__ import annotations

import csv
from pathlib import Path

from golden_files import compare, short

from hearth.homes import library
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.repair.augmentation import Augmented, Options, augment
from hearth.repair.runnable_predictions import complete
from hearth.repair.sketch import sketch
from hearth.repair.sketch_features import StepFeatures, features
from hearth.repair.sketch_model import shipped
from hearth.schemas.failures import Failure
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_program, print_step
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOT = Path(__file__).resolve().parents[2]
HOMES, STRENGTHS, EVERY = ("maple", "juniper", "rowan"), ("mild", "thesis"), 101


def _programs() -> list[tuple[str, Program]]:
    with (ROOT / "data_raw/written/programs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))[::EVERY]
    texts = [
        (
            each["HITId"],
            f"{each['Input.title']}\n{each['Input.description']}\n\n\n{each['Answer.program']}\n".replace("\r", ""),
        )
        for each in rows
    ]
    return [(name, check(parse_program(text)[0], default())[0]) for name, text in texts]


def _lines(program: Program) -> list[str]:
    return [print_step(step) for step in program.steps]


def _repaired(found: Augmented | Failure) -> object:
    if isinstance(found, Failure):
        return found.message()
    return [
        {
            "perturbed": [str(each) for each in pair.perturbations],
            "attempts": [f"{each.handler}: {each.failure.message() if each.failure else ''}" for each in pair.attempts],
            "became": pair.failure.message() if pair.failure else _lines(pair.program),
            "sources": list(pair.sources),
        }
        for pair in found.pairs
    ]


def _digest(steps: list[StepFeatures]) -> str:
    values = [(each.names, sorted((name, round(value, 6)) for name, value in each.numbers.items())) for each in steps]
    return short(values)


def _completed(program: Program, keep: tuple[bool, ...], home: Home) -> object:
    """The sketch, completed in another home."""
    kept = tuple(step for step, keeps in zip(program.steps, keep, strict=True) if keeps)
    found = complete(kept, World.start(home), default())
    return {"steps": _lines(found.execution.program), "left out": [each.message() for _, each in found.left_out]}


def test_what_becomes_of_written_programs():
    homes = [Home.from_graph(library.load_graph(name, default()), name, default()) for name in HOMES]
    found = {}
    for number, (name, program) in enumerate(_programs()):
        home, other = homes[number % len(homes)], homes[(number + 1) % len(homes)]
        keep = sketch(program, [home], default(), record_id=name)
        options = Options(count=2, strength=STRENGTHS[number % len(STRENGTHS)])
        found[f"{name} in {home.name}"] = {
            "repaired": _repaired(augment(program, home, number, name, options)),
            "sketch": "".join("x" if keeps else "." for keeps in keep),
            "learned": " ".join(f"{shipped().probability(each):.4f}" for each in features(program, keep, default())),
            "features": _digest(features(program, keep, default())),
            "completed": _completed(program, keep, other),
        }
    compare("repair/written.json", found)
