"""Attacks by files of episodes, which `replay` does again."""

from __future__ import annotations

import gzip
import json
from collections.abc import Iterator
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

from attack import Attack, Ground
from attacks_on_challenges import BAD, _filled, _read, _strange, _with

from hearth.kb.loading.load import default


def done_again(path: Path) -> Any:
    """Read the episodes of a file and do them again, as `replay` does."""
    from hearth.simulation.episode_files import read

    return [each.verify() for each in islice(read(path, default()), 10)]


@cache
def recorded() -> tuple[dict[str, Any], dict[str, Any]]:
    """The two lines of a true file: a home, and an episode of two in it who have places, grabbed things, and talk."""
    from tempfile import TemporaryDirectory

    from hearth.homes import library
    from hearth.schemas.agent_messages import Message
    from hearth.schemas.program import ObjectRef, Step
    from hearth.simulation.env import Env
    from hearth.simulation.episode import Episode
    from hearth.simulation.episode_files import write
    from hearth.simulation.world.edit import edit

    env = Env(knowledge=default())
    env.reset(library.names()[0], 2, seed=1)
    thing = next(iter(env.legal(0).objects("Walktowards", 0)))
    env.restore(edit(env.world, set=[(node.id, "OPEN") for node in env.world.graph().nodes if "CLOSED" in node.states]))
    for agent in (0, 1):
        ref = ObjectRef(env.world.home.classes[env.world.home.index[thing]], 0, thing)
        env.step({agent: Step("Walktowards", (ref,), agent), 1 - agent: Step("Turnleft", (), 1 - agent)})
    with TemporaryDirectory() as folder:
        path = Path(folder) / "episode.jsonl"
        write(path, [Episode.of(env, [{0: Message()}, {}])])
        home, episode = map(json.loads, path.read_bytes().splitlines())
    return home, episode


def _lines(home: Any, episode: Any) -> str:
    return f"{json.dumps(home)}\n{json.dumps(episode)}\n"


def _places(document: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """Yield the places of values in an episode: each field, and the first of each list and of each mapping."""
    waiting: list[tuple[tuple[Any, ...], Any]] = [((), document)]
    while waiting:
        place, value = waiting.pop()
        if place:
            yield place
        if isinstance(value, dict):
            inner = list(value) if len(place) < 2 else list(value)[:8]
        else:
            inner = list(range(min(len(value), 1))) if isinstance(value, list) else []
        waiting += [((*place, name), value[name]) for name in inner]


_FAR = 2**64
_LONG = "9" * 5_000
WORSE: dict[tuple[Any, ...], tuple[Any, ...]] = {
    ("start", "gone"): tuple([number] for number in (2**63, -(2**63), 10**30, 1.5, True)),
    ("start", "set"): tuple([[number, "ON"]] for number in (_FAR, "1", None, 10**30)),
    ("start", "cleared"): tuple([[1, state]] for state in ("\x1b[2J", "x" * 100_000, None, {})),
    ("start", "added"): (
        [[1, "ON", 1]], [[1, "on", 2]], [[1, 2, 3]], [["1", "ON", "2"]], [[1]], [[1] * 9], [[_FAR, "ON", 1]],
        [[1, "INSIDE", 2]], [[1, "HOLDS_RH", 2]],
    ),
    ("start", "nodes"): (
        [{}], [{"id": 1, "class_name": "x"}], [{"id": _FAR, "class_name": "cup"}],
        [{"id": 5_000, "class_name": "character"}], [{"id": 5_000, "class_name": ""}],
    ),
    ("start", "memories"): ([{}], [{"agent": 1, "thing": 1, "place": 1, "relation": "ON"}], [1]),
    ("rules", "doors"): ("x", 2, None),
    ("rules", "unknown"): (True,),
    ("ticks", 0): tuple({number: "[Walk] <sofa> (1)"} for number in ("99", "-1", "x", "1e5", "\u00b2", _LONG)),
    ("ticks", 0, "0"): (
        "[Fly]", "", "\n", "[Walk] <sofa> (9.9)", "[Walk] <sofa> (1.99999999999)", "[Walk]", "[Sleep] [Sleep]",
        "<char9> [Walk] <sofa> (1)", "[Grab] <cup> (1.12) {hand=third}", f"[Walk] <sofa> ({_LONG})",
    ),
    ("said",): (
        *([{"0": text}, {}] for text in ("Tell", "\x1b[2J", "<script>", "Tell ON(plate, 9999999999) 2")),
        *([{number: "Ask"}, {}] for number in ("-1", "99", "x")),
    ),
}  # fmt: skip
"""Values that are nearly right, by their place in an episode."""


def _packed(ground: Ground, data: bytes) -> Any:
    path = ground.folder / "given.jsonl.gz"
    path.write_bytes(data)
    return done_again(path)


def _bomb(ground: Ground) -> None:
    from hearth.schemas.diagnostics import HearthError

    try:
        _packed(ground, gzip.compress(bytes(1 << 30), 1))
    except HearthError as error:
        assert str(error.diagnostics[0].code) == "FILE_TOO_LARGE", error


def episodes() -> Iterator[Attack]:
    """Files of episodes with values that none has, damaged, and packed ones that never end."""
    yield from _strange("episodes", done_again)
    home, episode = recorded()
    wrong = [(place, bad) for place in _places(episode) for bad in BAD]
    for place, bad in (*wrong, *((place, bad) for place, values in WORSE.items() for bad in values)):

        def load(ground: Ground, place: tuple[Any, ...] = place, bad: Any = bad) -> Any:
            return _read(done_again, _lines(home, _with(episode, place, _filled(bad, ground))), ground)

        yield Attack("episodes", f"{'.'.join(map(str, place))[:40]} = {bad!r:.30}", load)
    for place in (("home",), ("key",), ("graph",), ("graph", "nodes"), ("graph", "edges"), ("graph", "nodes", 0)):
        for bad in BAD:

            def load_home(ground: Ground, place: tuple[Any, ...] = place, bad: Any = bad) -> Any:
                return _read(done_again, _lines(_with(home, place, _filled(bad, ground)), episode), ground)

            yield Attack("episodes", f"home: {'.'.join(map(str, place))} = {bad!r:.20}", load_home)
    yield Attack("episodes", "packed: a gigabyte of nothing", _bomb)
    for name, data in {
        "cut": gzip.compress(_lines(home, episode).encode())[:-20],
        "no gzip": b"{}",
        "empty": b"",
    }.items():
        yield Attack("episodes", f"packed: {name}", lambda ground, d=data: _packed(ground, d))
