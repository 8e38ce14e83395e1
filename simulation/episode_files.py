"""Files of episodes: written, and read back as they were.

A file has JSON lines. A line with `graph` is a home's; a line with `ticks` is an episode, which names the home and the
differences from it at its start. Files whose names end in `.gz` are compressed.
"""

from __future__ import annotations

import gzip
import io
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas import graph_change as changes
from hearth.schemas.agent_messages import Message
from hearth.schemas.agent_messages import read as read_message
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, EnvironmentGraph, from_release, read_node, to_release, word
from hearth.schemas.graph_change import Change
from hearth.schemas.numbers import stored
from hearth.schemas.program import Step
from hearth.schemas.syntax import parse_steps, print_step
from hearth.simulation.episode import Episode
from hearth.simulation.rules import read as read_rules
from hearth.simulation.world.digest import digest
from hearth.simulation.world.edit import apply, edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.simulation.world.world_json import private, with_private
from hearth.storage.archives import unpacked
from hearth.storage.chosen_files import writing
from hearth.storage.input_files import LARGEST, read_input


def write(path: Path, episodes: Iterable[Episode]) -> int:
    """Write episodes, each home once; the number of episodes."""
    import orjson

    homes: dict[str, EnvironmentGraph] = {}
    count = 0
    with writing(path) as temporary, _opened(temporary, path) as file:
        for episode in episodes:
            root = episode.start.home
            while root.base is not None:
                root = root.base[0]
            base = World.start(root)
            key = digest(base)
            if key not in homes:
                homes[key] = base.graph()
                file.write(orjson.dumps({"home": root.name, "key": key, "graph": to_release(homes[key])}) + b"\n")
            file.write(orjson.dumps(_row(episode, key, homes[key])) + b"\n")
            count += 1
    return count


def _opened(temporary: Path, path: Path) -> Any:
    # A compressed file without a time has the same bytes every time.
    return gzip.GzipFile("", "wb", 6, temporary.open("wb"), 0) if path.suffix == ".gz" else temporary.open("wb")


def _row(episode: Episode, key: str, base: EnvironmentGraph) -> dict[str, Any]:
    change = changes.encode(base, episode.start.graph())
    said = {"said": [{str(n): str(message) for n, message in sorted(each.items())} for each in episode.said]}
    return {
        "home": key,
        "start": {
            "added": list(map(tuple, change.added)),
            "removed": list(map(tuple, change.removed)),
            "set": change.set_states,
            "cleared": change.cleared_states,
            "nodes": to_release(EnvironmentGraph(change.added_nodes, ()))["nodes"],
            "gone": change.removed_nodes,
            **private(episode.start),
        },
        "rules": episode.rules._asdict(),
        "ticks": [{str(n): print_step(step) for n, step in sorted(each.items())} for each in episode.ticks],
        **(said if any(episode.said) else {}),
        "digests": episode.digests,
    }


def read(path: Path, knowledge: Knowledge) -> Iterator[Episode]:
    """Yield the episodes of a file, one after the other.

    Raises:
        HearthError: MISSING_FILE; FILE_TOO_LARGE; BAD_ARCHIVE; BAD_JSON, with the line, of anything but episodes and
            homes.
    """
    import orjson

    homes: dict[str, Home] = {}
    for number, line in enumerate(_lines(path), 1):
        try:
            row = orjson.loads(line)
            if "graph" in row:
                homes[row["key"]] = Home.from_graph(from_release(row["graph"]), word(row["home"]), knowledge)
            else:
                yield _episode(row, homes[row["home"]])
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            message = f"not an episode: {type(error).__name__} {error}"
            raise HearthError(Diagnostic(Code.BAD_JSON, message, str(path), number)) from error


def _lines(path: Path) -> Iterator[bytes]:
    data = read_input(path)
    with unpacked(data, str(path)) if path.suffix == ".gz" else io.BytesIO(data) as file:
        while line := file.readline(LARGEST + 1):
            if len(line) > LARGEST:
                raise HearthError.of(Code.FILE_TOO_LARGE, f"a line of more than {LARGEST:,} bytes", file=str(path))
            yield line


def _episode(row: Mapping[str, Any], home: Home) -> Episode:
    start = _start(row["start"], home)
    ticks = [{_agent(n): _read_step(text, int(n)) for n, text in each.items()} for each in row["ticks"]]
    said = [{_agent(n): _read_said(text) for n, text in each.items()} for each in row.get("said", [{}] * len(ticks))]
    digests = tuple(map(word, row["digests"]))
    if len(digests) != len(ticks) + 1 or len(said) != len(ticks):
        raise ValueError(f"{len(digests)} digests and {len(said)} rows of messages, of {len(ticks)} ticks")
    return Episode(start, read_rules(row["rules"]), tuple(ticks), digests, tuple(said))


def _start(given: Mapping[str, Any], home: Home) -> World:
    added, removed = (tuple(_edge(*edge) for edge in given[name]) for name in ("added", "removed"))
    on, off = (tuple((stored(node), word(state)) for node, state in given[name]) for name in ("set", "cleared"))
    nodes = tuple(map(read_node, given["nodes"]))
    found = edit(World.start(home), remove=map(stored, given["gone"]), add=nodes, check=False)
    assert isinstance(found, World)  # nothing is checked
    return with_private(apply(found, Change(added, removed, on, off)), given)


def _edge(source: Any, relation: Any, target: Any) -> Edge:
    return Edge(stored(source), word(relation), stored(target))


def _agent(number: str) -> int:
    """Return the number of an agent; unknown numbers have their own failure when the episode is re-run."""
    if not number.isdecimal() or len(number) > 3:
        raise ValueError(f"`{number[:20]}` is not the number of an agent")
    return int(number)


def _read_step(text: Any, agent: int) -> Step:
    """Return an instruction as it was tried: it need not be one that makes sense."""
    found = parse_steps(word(text))
    if isinstance(found, Diagnostic) or len(found) != 1:
        raise ValueError(f"`{text[:60]}` is not an instruction")
    return replace(found[0], agent=agent)


def _read_said(text: Any) -> Message:
    message = read_message(word(text))
    if message is None:
        raise ValueError(f"`{text[:60]}` is not a message")
    return message
