"""Readers of knowledge, tables, goals and answers of strangers: more targets of `guided_fuzz.py`."""

from __future__ import annotations

import contextlib
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fuzz_file_targets import One, Room, _by_file

FAST = ("entries", "tensors", "release", "code", "pddl", "jsonl", "figures", "mine", "score")
"""Readers that get tables with another value: those that take less than a second."""


def _layer(name: str) -> Room:
    """A file of knowledge, laid over ours."""

    def example() -> bytes:
        from attacks_on_knowledge import layer

        return layer(name)

    def read(folder: Path) -> Any:
        from attacks_on_knowledge import laid

        return laid(folder)

    return _in_folder(name, example, read)


def _facts(name: str) -> Room:
    """A file of the release's knowledge, compared with ours."""

    def example() -> bytes:
        from attacks_on_knowledge import FACTS

        return json.dumps(FACTS[name]).encode()

    def read(folder: Path) -> Any:
        from attacks_on_knowledge import compared

        return compared(folder)

    return _in_folder(name, example, read)


def _in_folder(name: str, example: Callable[[], bytes], read: Callable[[Path], Any]) -> Room:
    """A file of that name, read by its folder."""

    def reader(scratch: Path) -> One:
        folder = scratch / "read"
        folder.mkdir()

        def one(data: bytes) -> Any:
            (folder / name).write_bytes(data)
            return read(folder)

        return one

    return Room(example, reader)


def _predictions() -> bytes:
    from attacks_on_tables import predictions

    return predictions()


def _scored(path: Path) -> Any:
    from attacks_on_tables import scored

    return scored(path)


def _changed_table(scratch: Path) -> One:
    """Two bytes say which value of a dataset is replaced by the JSON after them, or by one that no build writes."""
    import pyarrow as pa
    from attacks_on_tables import changes, put, read_all, small

    every = changes()

    def one(data: bytes) -> Any:
        for name in ("dataset", "aside"):
            shutil.rmtree(scratch / name, ignore_errors=True)
        table, place, bad = every[int.from_bytes(data[:2]) % len(every)]
        with contextlib.suppress(ValueError, RecursionError):
            bad = json.loads(data[2:])
        with contextlib.suppress(pa.ArrowException, OverflowError, UnicodeError, TypeError):  # of another type
            folder = put(small(scratch / "dataset"), table, place, bad)
            return read_all(folder, scratch / "aside", FAST)
        return None

    return one


def _goals(scratch: Path) -> One:
    """A goal in a file, as text or as JSON."""
    from hearth.commands.inputs import read_goals
    from hearth.homes import library
    from hearth.kb.loading.load import default
    from hearth.simulation.world.home import Home

    home, path = Home.from_graph(library.load_graph("maple", default()), "maple", default()), scratch / "goal.json"

    def one(data: bytes) -> Any:
        path.write_bytes(data)
        return read_goals([f"@{path}"], home)

    return one


def _sayings(scratch: Path) -> One:
    """Return answers of a language model, or of an agent that may talk."""
    from hearth.envs.text_agent import understood
    from hearth.homes import library
    from hearth.kb.loading.load import default
    from hearth.simulation.actions.legal import legal
    from hearth.simulation.env import Env
    from hearth.simulation.observation.views import view
    from hearth.simulation.world.home import Home

    env = Env(knowledge=default())
    env.reset(Home.from_graph(library.load_graph("maple", default()), "maple", default()), 2)
    seen, may = view(env.world, 0), legal(env.world, 0, env.rules, only_visible=True)
    options = list(may)
    return lambda data: understood(data.decode("utf-8", "replace"), seen, may, options, messages=True)


def _game(scratch: Path) -> One:
    """Messages of a page that plays a game, one a line."""
    from hearth.kb.loading.load import default
    from hearth.web.messages import Inbox, int_field, text_field
    from hearth.web.play.games import Game
    from hearth.web.play.play_trials import published, trial
    from hearth.web.web_errors import WebError

    game = Game(trial(published("wah", "test-1", 0), default()), default())

    def one(data: bytes) -> Any:
        inbox, found = Inbox(), []
        for line in data.splitlines()[:50]:
            with contextlib.suppress(WebError):
                message = inbox.take(line)
                int_field(message, "tick", 0, 100_000)
                found.append(game.read(0, text_field(message, "act", 500)))
        return found

    return one


def _graph() -> bytes:
    from guided_fuzz import _GRAPH

    return _GRAPH[:-1] + b', "more": {"a": [1]}}'


def _edited(words: tuple[str, ...]) -> Callable[[Path], Any]:
    """A command that reads a graph and writes it."""

    def read(path: Path) -> Any:
        from typer.testing import CliRunner

        from hearth.cli import app

        out = path.with_name("written.json")
        out.unlink(missing_ok=True)
        done = CliRunner().invoke(app, ["--debug", *(word.format(file=path, out=out) for word in words)])
        if done.exception is not None and not isinstance(done.exception, SystemExit):
            raise done.exception
        return done.output

    return read


_ACTS = (
    b'{"type": "act", "n": 1, "tick": 0, "act": "[Walk] <sofa> (1)"}\n{"type": "act", "n": 2, "tick": 1, "act": ""}\n'
)
_GOAL = b'{"vh_goal": {"actions": ["GRAB"], "goal": [{"class_name": "plate", "id": 1, "state": "CLEAN"}]}}'

_FILES = (
    "actions.yaml", "actions_written.yaml", "affordances.yaml", "aliases.csv", "associations.csv", "derived.yaml",
    "kinds.csv", "limits.yaml", "objects_things.csv", "placements.csv", "repairs.yaml", "rooms.yaml", "stand_ins.csv",
    "states.yaml", "tables.yaml",
)  # fmt: skip
_RELEASE = ("properties_data", "object_states", "object_script_placing", "class_name_equivalence", "affordances")

TABLES: dict[str, Room] = {
    **{f"layer-{name.partition('.')[0]}": _layer(name) for name in _FILES},
    **{f"facts-{name}": _facts(f"{name}.json") for name in _RELEASE},
    "predictions": Room(_predictions, _by_file("predictions.parquet", _scored)),
    "tables": Room(lambda: b"\x00\x00[1]", _changed_table),
    "goal-file": Room(lambda: _GOAL, _goals),
    "agent-words": Room(lambda: b"I will look.\nTell ON(plate, 55) 2", _sayings),
    "game": Room(lambda: _ACTS, _game),
    "convert-home": Room(_graph, _by_file("home.json", _edited(("home", "convert", "{file}", "{out}")))),
    "convert-layout": Room(_graph, _by_file("home.json", _edited(("home", "convert", "{file}", "{out}", "--layout")))),
    "edit-home": Room(_graph, _by_file("home.json", _edited(
        ("home", "edit", "{file}", "--add", "pillow:on:2", "--out", "{out}")))),
}  # fmt: skip
