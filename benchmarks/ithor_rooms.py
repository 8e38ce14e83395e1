"""The 120 rooms of iTHOR as homes: how many have no faults, and how many run programs of ours that fit.

The metadata is `ai2thor-object-metadata.json` of the package `procthor`. A program fits a room if the room has a thing
for everything that it names. Programs run by action set 3, which executes every action. With --sheet, every fifth room
is rendered from above or by a camera in a corner.

Example:
  python benchmarks/ithor_rooms.py ai2thor-object-metadata.json --sheet rooms.png
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path

import orjson

import hearth
from hearth.analysis.programs_in_homes import Script, scripts
from hearth.homes.lint import lint
from hearth.interop.procthor.house_files import floor_plans
from hearth.interop.scene_graphs.reading import read_scene
from hearth.interop.scene_graphs.shape import usual
from hearth.kb.knowledge import Knowledge
from hearth.kb.loading.load import default
from hearth.rendering.arrays import Image
from hearth.rendering.cameras.camera import top_view
from hearth.rendering.cameras.viewpoints import home_box, room_views
from hearth.schemas.failures import Failure
from hearth.schemas.graph import EnvironmentGraph
from hearth.simulation.rules import CONSEQUENCES
from hearth.simulation.world.home import Home

SOURCES = Path(__file__).parents[1] / "data_raw"


def main() -> None:
    """Print a line for each room with faults or failures, and the counts."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("metadata", type=Path)
    options.add_argument("--sheet", type=Path, help="a picture of two dozen views")
    options.add_argument("--programs", type=int, default=10, help="programs in each room")
    options.add_argument("--corpus", type=Path, nargs="*", default=[SOURCES / "crowd", SOURCES / "written"])
    given = options.parse_args()
    known = default().of_set(3)
    corpus = [each for each in scripts(map(str, given.corpus), known) if isinstance(each, Script)]
    counts: Counter[str] = Counter()
    views: list[tuple[Image, str]] = []
    for number, (name, objects) in enumerate(floor_plans(orjson.loads(given.metadata.read_bytes())).items()):
        found = read_scene({"objects": objects}, usual(), known, name)
        faults = lint(found.graph, known, name)
        counts["rooms"] += 1
        counts["without faults"] += not faults
        for fault in faults:
            print(f"{name}: {fault}")
        home = Home.from_graph(found.graph, name, known)
        ran, failures = outcomes(fitting(corpus, home, known), home, given.programs)
        counts["rooms with enough programs that fit"] += ran + len(failures) >= given.programs
        counts[f"rooms that run {given.programs} programs"] += ran >= given.programs
        counts["programs that ran"] += ran
        counts["programs that failed"] += len(failures)
        for failure in failures:
            print(f"{name}: {failure}")
        if given.sheet and number % 5 == 0:
            views += pictures(found.graph, known, name, above=number % 10 == 0)
    if given.sheet:
        write_sheet(views, given.sheet)
    print(json.dumps(counts))


def fitting(corpus: Iterable[Script], home: Home, known: Knowledge) -> Iterator[Script]:
    """Yield the programs for whose every object a home has a thing of that class, or of one that may take its place."""
    classes = set(home.classes)
    for script in corpus:
        refs = {ref.name for step in script.program.steps for ref in step.objects}
        if all(classes & {*known.found_as(ref), *known.stand_ins(ref)} for ref in refs):
            yield script


def outcomes(programs: Iterable[Script], home: Home, most: int) -> tuple[int, list[str]]:
    """Return how many of the first programs ran in environments sampled in a home, and the failures of the others."""
    ran, failures = 0, []
    for script in programs:
        found = hearth.sample(script.program, home, 0, script.program_id, rules=CONSEQUENCES)
        if isinstance(found, Failure):
            failures.append(f"{script.place}: {found}")
        else:
            ran += 1
        if ran + len(failures) >= most:
            break
    return ran, failures


def pictures(graph: EnvironmentGraph, known: Knowledge, name: str, above: bool) -> Iterator[tuple[Image, str]]:
    """Yield a view of a room from above, or by a camera in a corner."""
    scene = hearth.scene_of(graph, known)
    camera = top_view(home_box(graph)) if above else next(iter(room_views(graph, 320, 240).values()))[0]
    yield hearth.render(scene, camera)["rgb"], f"{name} {'from above' if above else 'from a corner'}"


def write_sheet(views: list[tuple[Image, str]], path: Path) -> None:
    """Write views as one picture."""
    from hearth.rendering.film.contact_sheet import contact_sheet
    from hearth.rendering.film.png import encode

    path.write_bytes(encode(contact_sheet(views, "Rooms of iTHOR", columns=6)))


if __name__ == "__main__":
    main()
