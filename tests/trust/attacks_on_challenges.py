"""Attacks by files of tasks and of results, and by agents at the other end of a line."""

from __future__ import annotations

import contextlib
import json
import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from attack import DEEP, Attack, Ground

from hearth.challenges import result_files
from hearth.challenges import task_files as files
from hearth.kb.loading.load import default

BAD: tuple[Any, ...] = (
    None, True, -1, 10**30, 1e308, "", "../../guard/x", "{guard}/x", "x" * 100_000, "\x1b[2J", [], [[]], {},
    {"x": {}}, {"x": DEEP},
)  # fmt: skip


def _suite() -> dict[str, Any]:
    return files.suite_data(files.suite("wah", "test-1", limit=2))


def _filled(bad: Any, ground: Ground) -> Any:
    return bad.replace("{guard}", str(ground.guard)) if isinstance(bad, str) else bad


def _with(document: dict[str, Any], place: tuple[Any, ...], bad: Any) -> dict[str, Any]:
    copy: dict[str, Any] = json.loads(json.dumps(document))
    inner: Any = copy
    for name in place[:-1]:
        inner = inner[name]
    inner[place[-1]] = bad
    return copy


def _signed(document: dict[str, Any]) -> dict[str, Any]:
    """The document with the digest of what it now holds, as somebody who can run Hearth would write it."""
    from hearth.schemas.diagnostics import HearthError

    try:
        files.read_suite({**document, "digest": None}, "x")
    except HearthError as error:
        said = error.diagnostics[0].message.split()
        if "digest" in said:
            return {**document, "digest": said[said.index("digest") + 1].rstrip(",")}
    except Exception:  # what is attacked will fail in the same way, and be seen
        return document
    return document


PLACES: tuple[tuple[Any, ...], ...] = (
    *((name,) for name in ("format", "challenge", "split", "seed", "digest", "tasks")),
    *(("tasks", 0, name) for name in ("id", "home", "demonstration_home", "sets", "goal", "seed")),
    ("tasks", 0), ("tasks", 0, "sets", 0),
)  # fmt: skip


def _read(reader: Callable[[Path], Any], data: bytes | str, ground: Ground) -> Any:
    path = ground.folder / "given.json"
    path.write_bytes(data if isinstance(data, bytes) else data.encode("utf-8", "surrogateescape"))
    return reader(path)


STRANGE = {
    "deep": "[" * 100_000, "not text": b"\xff\xfe{", "number": "9" * 100_000, "nothing": "", "null": "null",
    "twice": '{"format": 1, "format": 2}', "NaN": '{"format": NaN}',
}  # fmt: skip


def _strange(group: str, reader: Callable[[Path], Any]) -> Iterator[Attack]:
    for name, text in STRANGE.items():
        yield Attack(group, name, lambda ground, t=text: _read(reader, t, ground))
    for name in ("/dev/zero", "pipe", "."):

        def opened(ground: Ground, name: str = name) -> Any:
            os.mkfifo(ground.folder / "pipe")
            return reader(ground.folder / name)

        yield Attack(group, f"file {name}", opened)


def _used(path: Path) -> Any:
    """Read tasks, and begin each of them."""
    from hearth.challenges.episodes import start_of

    return [start_of(task, default(), 1) for task in files.read(path).tasks]


def task_files() -> Iterator[Attack]:
    """Files of tasks with values that no task has; their digests are right."""
    yield from _strange("tasks", _used)
    suite = _suite()
    goal = suite["tasks"][0]["goal"]
    for place in (*PLACES, *(("tasks", 0, "goal", key) for key in goal)):
        for bad in BAD:

            def load(ground: Ground, place: tuple[Any, ...] = place, bad: Any = bad) -> Any:
                document = _with(suite, place, _filled(bad, ground))
                return _read(_used, json.dumps(_signed(document)), ground)

            yield Attack("tasks", f"{'.'.join(map(str, place))[:40]} = {bad!r:.20}", load)
    for key in ("on(plate, table)", "INSIDE(x, y)", "a" * 10_000, "\x1b[2J", "__class__", "{guard}"):
        yield Attack("tasks", f"goal {key[:30]!a}", lambda ground, k=key: _read(
            _used, json.dumps(_signed(_with(suite, ("tasks", 0, "goal"), {k: 1}))), ground))  # fmt: skip


def _played() -> list[bytes]:
    """The lines of a true file of results: one task, alone."""
    from hearth.challenges.episode_agents import Lineup
    from hearth.challenges.episodes import Job, played

    suite = files.suite("wah", "test-1", limit=1)
    header = result_files.Header(suite, Lineup("human_like", "none"), 1)
    record = played(Job(suite.tasks[0], 0, header.lineup, False, None, default))
    return [result_files.first_line(header), result_files.line(header, record)]


def _verified(path: Path) -> Any:
    from hearth.challenges.verification import verify

    found = result_files.read(path)
    faults = verify(found, str(path), default)
    metrics = [(each.metrics, each.final) for each in found.records]
    return [fault.message for fault in faults] or metrics, consumed(path)


def consumed(path: Path) -> Any:
    """Return the output of commands that read results without repeating them: figures, and rows of tables."""
    import pyarrow as pa

    from hearth.challenges.challenge_dataset import TABLES, _episode, _once, _trajectory
    from hearth.challenges.metrics import summary
    from hearth.challenges.verification import read_whole

    found = read_whole(path)
    figures = summary(found.outcomes(False), found.outcomes(True) if found.header.helped[-1] else {})
    ends = {each.end["code"] for each in found.records if each.end}
    rows = {
        "episodes": [_episode(header, each) for header, each in _once([found])],
        "trajectories": [row for header, each in _once([found]) for row in _trajectory(header, each)],
    }
    tables = [pa.Table.from_pylist(some, schema=TABLES[name]) for name, some in rows.items()]
    return figures, ends, len(tables)


def results() -> Iterator[Attack]:
    """Files of results that were changed, with digests that fit."""
    yield from _strange("results", _verified)
    first, second = (json.loads(line) for line in _played())
    for name in ("main", "helper", "goal"):
        for bad in (*BAD, "os:system", "{guard}/x.py:Helper"):
            yield _changed("results", _with(first, ("agents", name), bad), second, f"agents.{name} = {bad!r:.20}")
    for name in first:
        for bad in BAD:
            yield _changed("results", _with(first, (name,), bad), second, f"{name} = {bad!r:.20}")
    for name in second:
        for bad in BAD:
            yield _changed("results", first, _with(second, (name,), bad), f"episode {name} = {bad!r:.20}")
    for bad in (*BAD, "[Fly] <x> (1)", "[Walk] <sofa> (1.999999)", "[Walk] <sofa> (" + "9" * 5_000 + ")"):
        yield _changed("results", first, _with(second, ("actions", 0), [bad]), f"an action {bad!r:.20}")
    for name in second["metrics"]:
        for bad in BAD:
            yield _changed("results", first, _with(second, ("metrics", name), bad), f"metric {name} = {bad!r:.20}")
    many = json.dumps({**first, "seeds": 1_000})
    yield Attack("results", "more seeds than episodes", lambda ground: _read(_verified, many, ground))
    yield Attack("results", "no episodes", lambda ground: _read(consumed, json.dumps(first), ground))
    yield Attack("results", "millions of episodes", lambda ground: _read(consumed, _many(first), ground))
    yield Attack("results", "another first line", lambda ground: _read(consumed, json.dumps(second), ground))


def _many(first: dict[str, Any]) -> str:
    """A first line that says many more episodes than there are."""
    task = first["suite"]["tasks"][0]
    tasks = [{**task, "id": f"t{number}"} for number in range(10_000)]
    return json.dumps({**first, "suite": _signed({**first["suite"], "tasks": tasks}), "seeds": 1_000})


def _changed(group: str, first: dict[str, Any], second: dict[str, Any], title: str) -> Attack:
    def load(ground: Ground) -> Any:
        text = "\n".join(json.dumps(each).replace("{guard}", str(ground.guard)) for each in _resigned(first, second))
        return _read(_verified, text, ground)

    return Attack(group, title, load)


def _resigned(first: dict[str, Any], second: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    from hearth.challenges.result_files import _digest, read_header
    from hearth.schemas.diagnostics import HearthError

    try:
        header = read_header(json.dumps(first).encode(), "x")
        episode = {name: value for name, value in second.items() if name != "digest"}
        return first, {**episode, "digest": _digest(header, episode)}
    except (HearthError, TypeError, AttributeError):
        return first, second


LINES = (
    b"", b"{}", b"[]", b"null", b"\xff\xfe", b"[" * 60_000, b'{"tick": 0, "act": ' + b"9" * 5_000 + b"}",
    b'{"tick": 0, "act": -1}', b'{"tick": 0, "act": 1e999}', b'{"tick": 0, "act": true}', b'{"tick": 0, "act": []}',
    b'{"tick": 0, "act": {"__class__": 1}}', b'{"tick": 99, "act": 0}', b'{"tick": -1, "act": 0}',
    b'{"tick": "0", "act": 0}', b'{"tick": 0, "agent": 2, "act": 0}', b'{"tick": 0, "act": "[Grab] <x> (9.9)"}',
    b'{"tick": 0, "act": "<char7> [Walk] <sofa> (1)"}', b'{"tick": 0, "act": "' + b"a" * 60_000 + b'"}',
    b'{"tick": 0, "act": "\\u001b[2J"}', b'{"tick": 0, "act": "Walk sofa 99999999999999999999999"}',
    b'{"type": "end"}', b"x" * 300_000, b'{"tick": 0, "act": "[Walk] <sofa> (1), [Grab] <cup> (1)"}',
    b'{"tick": 0, "act": "[Walk]\\n[Walk]"}', b"\x00" * 100, b'{"tick": 1e18, "act": null}', b"GET / HTTP/1.1",
)  # fmt: skip
"""Lines that clients send instead of an answer."""


def clients() -> Iterator[Attack]:
    """Agents that send anything else than answers: the episode goes on, unharmed, to its end."""
    for line in LINES:
        yield Attack("client", f"{line[:50]!r}", lambda ground, sent=line: _against(sent))


def _against(sent: bytes) -> Any:
    from hearth.challenges.agent_channels import Channel
    from hearth.challenges.episode_loop import Player, play
    from hearth.challenges.episodes import start_of
    from hearth.challenges.wire_protocol import WireAgent

    task = files.suite("wah", "test-1", limit=1).tasks[0]
    there, here = os.pipe(), os.pipe()  # to the client, from the client
    stop = threading.Event()

    def babble() -> None:
        while not stop.is_set():
            if not os.read(there[0], 1 << 16):
                return
            with contextlib.suppress(OSError):  # the episode is over
                os.write(here[1], sent + b"\n")

    threading.Thread(target=babble, daemon=True).start()
    ends = (lambda: os.close(here[0]), lambda: os.close(there[1]))
    channel = Channel(lambda size: os.read(here[0], size), lambda data: os.write(there[1], data), ends)
    agent = WireAgent(channel, within=3.0)
    try:
        done = play(start_of(task, default(), 1), task.goal, [Player(agent, task.goal)], 0, limit=5)
        assert done.ticks == 5, f"the episode ended after {done.ticks} ticks"
        faults = [fault.as_json() for fault in agent.faults]
        arrived = any(fault["code"] != "TIMED_OUT" for fault in faults)
        assert arrived or len(sent) > 1 << 16, "nothing that was sent arrived"  # who only writes does not read, either
        return faults
    finally:
        stop.set()
        channel.close()
        for end in (there[0], here[1]):
            os.close(end)
