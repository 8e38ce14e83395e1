"""The rules `evolving_graph` against the programs that the Embodied Agent Interface takes as gold.

They are files of the wheel `virtualhome-eval`; `pip install virtualhome-eval` anywhere, and name
the folder of the package by HEARTH_VIRTUALHOME_EVAL.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from hearth.grounding.binding import bind_stored
from hearth.kb import action_grammar
from hearth.kb.loading.load import default
from hearth.schemas.failures import Failure
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import run
from hearth.simulation.rules import EVOLVING_GRAPH, REPLAY
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

PACKAGE = os.environ.get("HEARTH_VIRTUALHOME_EVAL", "")
ROOT = "dataset/programs_processed_precond_nograb_morepreconds"


EXPECTED = (342, {"evolving_graph": 341, "replay": 342})
"""Programs, and how many run: one grabs what it holds already, which only the release of 2018 allows."""


def gold():
    """The programs of the interface's tasks, with the graphs in which they begin."""
    known, folder = default(), Path(PACKAGE)
    tasks = json.loads((folder / "resources/virtualhome/id2task.json").read_text())
    for path in sorted((folder / ROOT / "executable_programs").rglob("file*.txt")):
        place = path.relative_to(folder / ROOT / "executable_programs").with_suffix(".json")
        pair = folder / ROOT / "init_and_final_graphs" / place
        if path.stem.removeprefix("file") in tasks and pair.is_file():
            program, _ = action_grammar.check(parse_program(path.read_text(), str(path))[0], known)
            home = Home.from_release(json.loads(pair.read_text())["init_graph"], "", known)
            yield path.stem, program, World.start(home)


@pytest.mark.skipif(not PACKAGE, reason="HEARTH_VIRTUALHOME_EVAL names no folder of the package virtualhome-eval")
def test_how_many_gold_programs_run():
    ran = {"evolving_graph": 0, "replay": 0}
    count = 0
    for _, program, world in gold():
        count += 1
        for name, rules in (("evolving_graph", EVOLVING_GRAPH), ("replay", REPLAY)):
            found = bind_stored(program, world, rules)
            assert not isinstance(found, Failure)
            ran[name] += run(world, found.apply(program), rules).executable
    assert (count, ran) == EXPECTED
