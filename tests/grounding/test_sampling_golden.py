"""Needs of programs, and the environments drawn for them, stay as they are until somebody means to change them."""

import csv
from pathlib import Path

import pytest
from golden_files import compare, short

from hearth.grounding.binding import bind
from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.homes import library
from hearth.kb.action_grammar import check
from hearth.schemas.failures import Failure
from hearth.schemas.syntax import parse_program, print_step
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

ROOT = Path(__file__).resolve().parents[2]
HOMES, EVERY = ("maple", "birch", "willow"), 37
SIZES = (Size(), Size.about(290))


def _described(found, inferred) -> object:
    if isinstance(found, Failure):
        return found.message()
    environment, execution = found
    differs = (environment.nodes, environment.placed, environment.removed, environment.states, environment.left_out)
    return {
        "abduced": [text for each in environment.conditions if (text := str(each)) not in inferred],
        "bound": " ".join(print_step(step) for step in environment.program.steps),
        "counts": " ".join(str(len(each)) for each in (*differs, environment.movable)),
        "digest": short((differs, environment.movable)),
        "runs": execution.executable,
    }


def _nearest(program, home) -> str:
    found = bind(program, World.start(home))
    return found.message() if isinstance(found, Failure) else short(sorted(found.nodes.items()))


@pytest.fixture(scope="module")
def drawn(knowledge) -> dict[str, object]:
    """By id of a written program and home: its inferred conditions, an environment drawn for it, how it is bound."""
    homes = [Home.from_graph(library.load_graph(name, knowledge), name, knowledge) for name in HOMES]
    with (ROOT / "data_raw/written/programs.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))[::EVERY]
    found: dict[str, object] = {}
    for number, row in enumerate(rows):
        text = f"{row['Input.title']}\n{row['Input.title']}\n\n\n{row['Answer.program']}\n"
        program = check(parse_program(text)[0], knowledge)[0]
        home = homes[number % len(homes)]
        conditions = infer(program, knowledge)
        inferred = conditions.message() if isinstance(conditions, Failure) else list(map(str, conditions))
        sampled = sample(program, home, number, row["HITId"], size=SIZES[number % len(SIZES)])
        found[f"{row['HITId']} in {home.name}"] = {
            "inferred": inferred,
            "drawn": _described(sampled, inferred),
            "nearest": _nearest(program, home),
        }
    return found


def test_what_is_drawn_for_written_programs(drawn):
    compare("grounding/drawn.json", drawn)


def test_most_of_them_run(drawn):
    runs = [isinstance(each["drawn"], dict) and each["drawn"]["runs"] for each in drawn.values()]
    assert sum(runs) > 0.9 * len(runs)
