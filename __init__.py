"""Hearth turns what people say they do at home into datasets that machines can run.

The usual entry points are attributes of this package, as `hearth.run`; each is imported when it is first used.
Their modules are those of `__init__.pyi`, which type checkers read too.
"""

from __future__ import annotations

import sys
from functools import lru_cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

from hearth.old_names import install
from hearth.schemas.call_errors import explained
from hearth.version import VERSION

if TYPE_CHECKING:
    from duckdb import DuckDBPyConnection

    from hearth.datasets.dataset import Dataset
    from hearth.kb.knowledge import Knowledge
    from hearth.schemas.diagnostics import Diagnostic
    from hearth.schemas.program import Program
    from hearth.simulation.env import Env
    from hearth.simulation.world.home import Home

__version__ = VERSION
install()
if sys.modules.get("gymnasium") is not None:  # its `make` then knows `hearth/Home-v0`; nobody else pays for it
    import_module("hearth.challenges.named_task_envs")


@lru_cache(maxsize=1)
def _modules() -> dict[str, str]:
    """Return the module of each entry point."""
    import re

    return {name: module for module, name in re.findall(r"^from (\S+) import (\w+) as \2$", _stub(), re.MULTILINE)}


def _stub() -> str:
    from pathlib import Path

    return Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8")


def __getattr__(name: str) -> Any:
    """Return an entry point, imported when it is first used."""
    if name == "__all__":
        return _public()
    if name == "Env":
        value = _env()
    elif name in _modules():
        value = getattr(import_module(_modules()[name]), name)
        if not isinstance(value, type):
            value = explained(value)
            value.__module__ = __name__  # where it is found when it is pickled
    else:
        raise AttributeError(f"module `hearth` has no attribute `{name}`")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """Return the entry points, and the names that every module has: notebooks complete them."""
    ours = (name for name in globals() if name.startswith("__"))
    return sorted({*ours, *_public(), *_rooms()})


def _public() -> list[str]:
    """Return the entry points, sorted: `__all__`, made when it is asked for."""
    import re

    return sorted({*_modules(), *re.findall(r"^def (\w+)", _stub(), re.MULTILINE)})


def _rooms() -> set[str]:
    """Return the subpackages that are imported, which are attributes, too."""
    return {name.split(".")[1] for name in sys.modules if name.startswith(f"{__name__}.")}


def _env() -> type[Env]:
    """Return the environment, by default with our own knowledge."""
    from hearth.simulation import env
    from hearth.simulation.rules import DEFAULT, Rules

    class Env(env.Env):
        __doc__, __qualname__ = env.Env.__doc__, "Env"

        def __init__(self, rules: Rules = DEFAULT, partial: bool = True, knowledge: Knowledge | None = None) -> None:
            super().__init__(rules, partial, _or_ours(knowledge))

    for method in (env.Env.reset, env.Env.restore, env.Env.step, env.Env.observe, env.Env.legal):
        setattr(Env, method.__name__, explained(method))
    return Env


def _or_ours(given: Knowledge | None) -> Knowledge:
    return given or knowledge()


@explained
def load(path: str, failures: bool = False) -> Dataset:
    """Open a published dataset folder for reading.

    Args:
        path: a dataset, or the folder of a build; may be a URL that fsspec reads.
        failures: whether runs, tensors, exports and scores have the executions in which the program fails, too.

    Raises:
        HearthError: the folder is not a dataset, or was written by a newer version.

    Examples:
        >>> dataset = hearth.load(folder)
        >>> list(dataset)[:2]
        ['text:milk.txt', 'text:milk.txt+maple.0']
        >>> dataset["text:milk.txt"].title
        'Fetch milk'
        >>> {run.executable for run in hearth.load(folder, failures=True)["text:milk.txt"].runs}
        {False, True}
    """
    from hearth.datasets.dataset import Dataset

    return Dataset.open(path, failures)


@explained
def attach(connection: DuckDBPyConnection, path: str, name: str) -> None:
    """Give a DuckDB connection of yours a dataset's tables, views and macros, as those of a database `name`.

    `ATTACH` of `catalog.duckdb` alone does not find the folder that the file lies in.

    Args:
        connection: as `duckdb.connect()` makes it.
        path: a dataset, or the folder of a build; it must stay where it is.
        name: of the database, as `ATTACH ... AS name` has it.

    Raises:
        HearthError: the folder is not a dataset; BAD_ARGUMENT, where the connection has that name already.

    Examples:
        >>> import duckdb
        >>> connection = duckdb.connect()
        >>> hearth.attach(connection, folder, "h")
        >>> connection.sql("SELECT title FROM h.originals JOIN h.steps USING (program_id) LIMIT 1").fetchall()
        [('Fetch milk',)]
    """
    from hearth.datasets.dataset import Dataset

    Dataset.open(path).attach_to(connection, name)


@explained
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


@explained
def home(name: str, knowledge: Knowledge | None = None) -> Home:
    """One of our homes by name (`homes.library.names()` lists them), or that of a file; by default with our knowledge.

    Args:
        name: or the path of a scene graph (`.json`, see `schemas.graph`) or of a plan (`.yaml`).
        knowledge: what its classes are.

    Raises:
        HearthError: UNKNOWN_HOME, or every fault of the file.

    Examples:
        >>> hearth.home("maple")
        Home('maple', 367 nodes)
    """
    from hearth.homes.library import named_graph
    from hearth.simulation.world.home import Home

    known = _or_ours(knowledge)
    title, graph = named_graph(str(name), known)
    return Home.from_graph(graph, title, known)


@explained
def parse_program(text: str, knowledge: Knowledge | None = None) -> Program:
    """Read a program from text, with canonical names by the grammar (thesis 2.3.3).

    The text is an optional title and description, then one instruction a line: `[Action] <object> (instance)`.
    `parse_steps` reads plans in words. `schemas.syntax.parse_program` and `kb.action_grammar.check` return faults
    instead of raising them.

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
    from hearth.kb.action_grammar import check
    from hearth.schemas.diagnostics import HearthError
    from hearth.schemas.syntax import parse_program

    program, faults = parse_program(text)
    faults = faults if program.steps else tuple(_with_reader_of_plans(text, fault) for fault in faults)
    checked, wrong = check(program, _or_ours(knowledge), source=text.splitlines())
    if faults or wrong:
        raise HearthError([*faults, *wrong])
    return checked


def _with_reader_of_plans(text: str, fault: Diagnostic) -> Diagnostic:
    """Return the fault of a text without steps; where it is a plan in words, with the function that reads those."""
    from dataclasses import replace

    from hearth.kb.language.program_lines import is_plan
    from hearth.schemas.failures import Code

    if fault.code not in (Code.EMPTY, Code.SYNTAX) or not is_plan(text.split("\n")):
        return fault
    remedy = "a plan in words is read by `hearth.parse_steps(text)`, or by `hearth check FILE`"
    return replace(fault, suggestion=remedy)
