"""Models need the extra `models`; their tests are skipped without it."""

from __future__ import annotations

import importlib.util
import shutil
from random import Random

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import hearth
from hearth.homes import library
from hearth.models.text_examples import Corpus, Example
from hearth.schemas.program import ObjectRef, Step
from hearth.schemas.syntax import parse_steps
from hearth.simulation.actions.legal import legal
from hearth.simulation.engine import act
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World


@pytest.fixture(autouse=True)
def torch_is_there():
    if importlib.util.find_spec("torch") is None or importlib.util.find_spec("safetensors") is None:
        pytest.skip("the extra `models` is not installed")


@pytest.fixture(scope="session")
def dataset(made):
    return hearth.load(made.out)


@pytest.fixture(scope="session")
def parted(made, tmp_path_factory):
    """The same dataset with every third activity in `test`, and every third in `validation`."""
    folder = shutil.copytree(made.out, tmp_path_factory.mktemp("parted") / "out")
    (path,) = (folder / "publish/splits").glob("*.parquet")
    table = pq.read_table(path)
    activities = hearth.load(made.out).rows("SELECT program_id, activity_id FROM programs")[1]
    order = {name: number for number, name in enumerate(sorted({activity for _, activity in activities}))}
    number = {program: order[activity] for program, activity in activities}
    parts = pa.array([("train", "test", "validation")[number[row] % 3] for row in table["program_id"].to_pylist()])
    place = table.schema.get_field_index("part")
    table = table.set_column(place, table.schema.field(place), parts.cast(table.schema.field(place).type))
    pq.write_table(table, path)
    return hearth.load(folder)


def steps_of(*lines):
    return tuple(step for line in lines for step in parse_steps(line))


TEXTS = (
    ("Watch TV", "Go to the living room, turn on the television and watch it.",
     ("[Walk] <living_room> (1)", "[SwitchOn] <television> (1)", "[Watch] <television> (1)")),
    ("Wash hands", "I wash my hands at the sink with soap.",
     ("[Walk] <bathroom> (1)", "[SwitchOn] <faucet> (1)", "[Wash] <hands_both> (1)", "[SwitchOff] <faucet> (1)")),
    ("Drink milk", "Take the milk out of the fridge and drink it.",
     ("[Walk] <kitchen> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Drink] <milk> (1)")),
    ("Read", "Grab a novel, sit down on the couch and read.",
     ("[Grab] <novel> (1)", "[Walk] <couch> (1)", "[Sit] <couch> (1)", "[Read] <novel> (1)")),
    ("Sleep", "Go to bed and sleep.", ("[Walk] <bedroom> (1)", "[Lie] <bed> (1)", "[Sleep]")),
    ("Set the table", "Put a plate on the table.", ("[Grab] <plate> (1)", "[PutBack] <plate> (1) <table> (1)")),
    ("Light", "Turn on the light.", ("[SwitchOn] <light> (1)",)),
    ("Two plates", "Take two plates.", ("[Grab] <plate> (1)", "[Grab] <plate> (2)")),
)  # fmt: skip


@pytest.fixture(scope="session")
def eight():
    """Eight examples of different activities."""
    return tuple(
        Example(f"text:{number}", title, title, description, steps_of(*lines), (f"text:{number}@maple",))
        for number, (title, description, lines) in enumerate(TEXTS)
    )


@pytest.fixture
def tiny(dataset, eight):
    """A corpus of the eight, which are for validation, too."""
    return Corpus(dataset, "activities", eight, eight)


NAMES = ("birch", "cedar", "juniper", "larch", "maple", "rowan", "willow")


def wandered(world: World, random: Random, steps: int) -> World:
    """The world after random steps that the engine does not refuse."""
    for _ in range(steps):
        could = legal(world)
        action = random.choice(sorted(could.masks))
        wanted = [random.choice(could.objects(action, place)) for place in range(len(could.masks[action]))]
        after = act(world, Step(action, tuple(ref_of(world, node) for node in wanted)))
        world = after if isinstance(after, World) else world
    return world


def ref_of(world: World, node: int) -> ObjectRef:
    """A reference to a node by its class."""
    return ObjectRef(world.home.classes[world.home.index[node]], 1, node)


@pytest.fixture(scope="session")
def environments(knowledge) -> list[World]:
    """Two hundred worlds."""
    homes = [Home.from_graph(library.load_graph(name, knowledge), name, knowledge) for name in NAMES]
    starts = [World.start(home) for home in homes]
    return [wandered(starts[n % len(starts)], Random(n), n % 12) for n in range(200)]
