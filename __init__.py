"""Hearth turns what people say they do at home into datasets that machines can run.

The usual entry points are attributes of this package, as `hearth.run`; each is imported when it is first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from hearth.version import VERSION

if TYPE_CHECKING:
    from hearth.datasets.dataset import Dataset as Dataset
    from hearth.datasets.export.formats import export as export
    from hearth.datasets.verify import verify as verify
    from hearth.grounding.binding import bind as bind
    from hearth.grounding.environments.sampling import sample as sample
    from hearth.grounding.preconditions.infer import infer as infer
    from hearth.homes.library import load_graph as load_graph
    from hearth.homes.procedural.generate import generate as generate
    from hearth.kb.knowledge import Knowledge
    from hearth.kb.language.understanding import understand as understand
    from hearth.kb.tools.find import Query as Query
    from hearth.kb.tools.find import find as find
    from hearth.pipelines.build import build as build
    from hearth.rendering.film.snapshots import trajectory_of as trajectory_of
    from hearth.rendering.film.video import record as record
    from hearth.rendering.modalities import render as render
    from hearth.rendering.scene.prepared import scene_of as scene_of
    from hearth.repair.sketch import sketch as sketch
    from hearth.repair.variants import augment as augment
    from hearth.schemas.goals import Goal as Goal
    from hearth.schemas.literals import Literal as Literal
    from hearth.schemas.program import Program
    from hearth.scoring.evaluate import evaluate as evaluate
    from hearth.scoring.metrics.executability import executability as executability
    from hearth.scoring.predictions import read_pairs as read_pairs
    from hearth.simulation.engine import run as run
    from hearth.simulation.env import Env as Env
    from hearth.simulation.goals import Progress as Progress
    from hearth.simulation.holds import holds as holds
    from hearth.simulation.world.edit import edit as edit
    from hearth.simulation.world.home import Home as Home
    from hearth.simulation.world.world import World as World

__version__ = VERSION

_PLACES = """
datasets.dataset:Dataset datasets.export.formats:export datasets.verify:verify grounding.binding:bind
grounding.environments.sampling:sample grounding.preconditions.infer:infer homes.library:load_graph
homes.procedural.generate:generate kb.language.understanding:understand kb.tools.find:find kb.tools.find:Query
pipelines.build:build rendering.film.snapshots:trajectory_of rendering.film.video:record rendering.modalities:render
rendering.scene.prepared:scene_of repair.sketch:sketch repair.variants:augment schemas.goals:Goal
schemas.literals:Literal scoring.evaluate:evaluate scoring.metrics.executability:executability
scoring.predictions:read_pairs simulation.engine:run simulation.goals:Progress simulation.holds:holds
simulation.world.edit:edit simulation.world.home:Home simulation.world.world:World
"""
_MODULES = {name: module for module, name in (place.split(":") for place in _PLACES.split())}


def __getattr__(name: str) -> Any:
    """An entry point, imported when it is first used."""
    from importlib import import_module

    if name == "Env":
        value = _env()
    elif name in _MODULES:
        value = getattr(import_module(f"hearth.{_MODULES[name]}"), name)
    else:
        raise AttributeError(f"module `hearth` has no attribute `{name}`")
    globals()[name] = value
    return value


def _env() -> type[Env]:
    """The environment, by default with our own knowledge."""
    from hearth.simulation import env
    from hearth.simulation.rules import DEFAULT, Rules

    class Env(env.Env):
        __doc__, __qualname__ = env.Env.__doc__, "Env"

        def __init__(self, rules: Rules = DEFAULT, partial: bool = True, knowledge: Knowledge | None = None) -> None:
            super().__init__(rules, partial, _or_ours(knowledge))

    return Env


def _or_ours(given: Knowledge | None) -> Knowledge:
    return given or knowledge()


def load(path: str) -> Dataset:
    """Open a published dataset folder for reading.

    Raises:
        HearthError: the folder is not a dataset, or was written by a newer version.

    Examples:
        >>> dataset = hearth.load(folder)
        >>> list(dataset)[:2]
        ['text:milk.txt', 'text:milk.txt+maple.0']
        >>> dataset["text:milk.txt"].title
        'Fetch milk'
    """
    from hearth.datasets.dataset import Dataset

    return Dataset.open(path)


def knowledge(overlay: str | None = None) -> Knowledge:
    """Hearth's knowledge of actions, objects and places, with the files of the folder `overlay` laid over it.

    A dataset's own knowledge is `load(path).knowledge`.

    Raises:
        HearthError: every fault of the overlay's files.

    Examples:
        >>> known = hearth.knowledge()
        >>> known.objects["fridge"].rooms, known.affords("Open", 0, "fridge")
        (('kitchen',), True)
    """
    from pathlib import Path

    from hearth.kb.loading.load import overlaid

    return overlaid(Path(overlay) if overlay else None)


def home(name: str, knowledge: Knowledge | None = None) -> Home:
    """One of our homes by name (`homes.library.names()` lists them), by default with our knowledge.

    Raises:
        HearthError: UNKNOWN_HOME.

    Examples:
        >>> hearth.home("maple")
        Home('maple', 367 nodes)
    """
    from hearth.homes.library import load_graph
    from hearth.simulation.world.home import Home

    known = _or_ours(knowledge)
    return Home.from_graph(load_graph(name, known), name, known)


def parse_program(text: str, knowledge: Knowledge | None = None) -> Program:
    """Read a program from text, with canonical names by the grammar (thesis 2.3.3).

    The text is an optional title and description, then one instruction a line: `[Action] <object> (instance)`.
    `schemas.syntax.parse_program` and `kb.grammar.check` return faults instead of raising them.

    Raises:
        HearthError: all faults of syntax and grammar, with line and column.

    Examples:
        >>> hearth.parse_program("[WALK] <Fridge> (1)").steps[0].action
        'Walk'
        >>> hearth.parse_program("[Flie] <fridge> (1)")
        Traceback (most recent call last):
            ...
        hearth.schemas.diagnostics.HearthError: 1:2: UNKNOWN_ACTION: unknown action `Flie` (did you mean `Lie`?)
    """
    from hearth.kb.grammar import check
    from hearth.schemas.diagnostics import HearthError
    from hearth.schemas.syntax import parse_program

    program, faults = parse_program(text)
    checked, wrong = check(program, _or_ours(knowledge), source=text.splitlines())
    if faults or wrong:
        raise HearthError([*faults, *wrong])
    return checked
