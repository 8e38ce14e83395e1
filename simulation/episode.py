"""Episodes that can be done again: recorded, written to a file, read back, and checked by a digest of every tick.

A file has JSON lines. A line with `graph` is a home's; a line with `ticks` is an episode, which names the home and what
is different from it at its start. Files whose names end in `.gz` are compressed.
"""

from __future__ import annotations

import gzip
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from hashlib import blake2b
from pathlib import Path
from typing import Any

from hearth.kb.knowledge import Knowledge
from hearth.schemas import change as changes
from hearth.schemas.change import Change
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.graph import Edge, EnvironmentGraph, from_release, read_node, to_release
from hearth.schemas.program import Step
from hearth.schemas.syntax import parse_steps, print_step
from hearth.simulation.engine import tick
from hearth.simulation.env import Env
from hearth.simulation.rules import Rules
from hearth.simulation.world.digest import digest
from hearth.simulation.world.edit import apply, edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.snapshot import private, with_private
from hearth.simulation.world.world import World
from hearth.storage.files import replacing
from hearth.storage.input_files import read_input

Instructions = Mapping[int, Step]
"""What each agent tries in a tick, by number."""


Said = Mapping[int, str]
"""What each agent says in a tick, by number."""


@dataclass(frozen=True, eq=False)
class Episode:
    """What happened in an episode. Two are equal if their digests are.

    Attributes:
        start: the world at its start.
        rules: how actions were read.
        ticks: what each agent tried.
        digests: of the start, then of each tick: of the digest before, what was tried, what failed, what was said, the
            world after.
        said: what agents said in each tick, by number.
    """

    start: World
    rules: Rules
    ticks: tuple[Instructions, ...]
    digests: tuple[str, ...]
    said: tuple[Said, ...]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Episode) and self.digests == other.digests

    def __hash__(self) -> int:
        return hash(self.digests)

    @classmethod
    def of(cls, env: Env, said: Sequence[Said] = ()) -> Episode:
        """The episode of an environment up to now, with what agents said in each tick.

        Raises:
            HearthError: UNKNOWN_HOME before the first `reset`.
        """
        start = env.ticks[0].before if env.ticks else env.world
        digests = [digest(start)]
        spoken: tuple[Said, ...] = tuple(said) or ({},) * len(env.ticks)
        for each, words in zip(env.ticks, spoken, strict=True):
            digests.append(_following(digests[-1], each.instructions, each.failures, words, each.world))
        return cls(start, env.rules, tuple(each.instructions for each in env.ticks), tuple(digests), spoken)

    def again(self) -> Iterator[tuple[World, str]]:
        """Do it again: the world and the digest at the start and after each tick."""
        world, last = self.start, digest(self.start)
        yield world, last
        for instructions, words in zip(self.ticks, self.said, strict=True):
            world, failures = tick(world, instructions, self.rules)
            last = _following(last, instructions, failures, words, world)
            yield world, last

    def verify(self) -> Diagnostic | None:
        """The first tick (from 1; 0 is the start) that is not as recorded; None if all are."""
        for number, ((_, found), recorded) in enumerate(zip(self.again(), self.digests, strict=True)):
            if found != recorded:
                message = f"tick {number} is not as recorded: its digest is {found}, and {recorded} was stored"
                return Diagnostic(Code.REPLAY_DIFFERS, message, line=number, found=found)
        return None


def _following(last: str, instructions: Instructions, failures: Mapping[int, Failure], said: Said, world: World) -> str:
    tried = ((number, print_step(step), str(failures[number].code) if number in failures else "")
             for number, step in sorted(instructions.items()))  # fmt: skip
    return blake2b(repr((last, *tried, *sorted(said.items()), digest(world))).encode(), digest_size=16).hexdigest()


def write(path: Path, episodes: Iterable[Episode]) -> int:
    """Write episodes, each home once; the number of episodes."""
    import orjson

    homes: dict[str, EnvironmentGraph] = {}
    count = 0
    with replacing(path) as temporary, _opened(temporary, path) as file:
        for episode in episodes:
            root = episode.start.home
            while root.base is not None:
                root = root.base[0]
            base = World.start(root)
            key = digest(base)
            if key not in homes:
                homes[key] = base.graph()
                file.write(orjson.dumps({"home": root.name, "key": key, "graph": to_release(homes[key])}) + b"\n")
            file.write(orjson.dumps(_line(episode, key, homes[key])) + b"\n")
            count += 1
    return count


def _opened(temporary: Path, path: Path) -> Any:
    # A compressed file without a time has the same bytes every time.
    return gzip.GzipFile("", "wb", 6, temporary.open("wb"), 0) if path.suffix == ".gz" else temporary.open("wb")


def _line(episode: Episode, key: str, base: EnvironmentGraph) -> dict[str, Any]:
    change = changes.encode(base, episode.start.graph())
    said = {"said": [{str(n): text for n, text in sorted(each.items())} for each in episode.said]}
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
    """The episodes of a file, one after the other.

    Raises:
        HearthError: MISSING_FILE; BAD_JSON, with the line, of anything but episodes and homes.
    """
    import orjson

    data = read_input(path)
    lines = (gzip.decompress(data) if path.suffix == ".gz" else data).splitlines()
    homes: dict[str, Home] = {}
    for number, line in enumerate(lines, 1):
        try:
            row = orjson.loads(line)
            if "graph" in row:
                homes[row["key"]] = Home.from_graph(from_release(row["graph"]), row["home"], knowledge)
            else:
                yield _episode(row, homes[row["home"]])
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            message = f"not an episode: {type(error).__name__} {error}"
            raise HearthError(Diagnostic(Code.BAD_JSON, message, str(path), number)) from error


def _episode(row: Mapping[str, Any], home: Home) -> Episode:
    start = row["start"]
    edges = [tuple(Edge(*edge) for edge in start[name]) for name in ("added", "removed")]
    states = [tuple((int(node), str(state)) for node, state in start[name]) for name in ("set", "cleared")]
    world = World.start(home)
    found = edit(world, remove=start["gone"], add=tuple(map(read_node, start["nodes"])), check=False)
    assert isinstance(found, World)
    found = with_private(apply(found, Change(edges[0], edges[1], states[0], states[1])), start)
    ticks = [{int(n): _read(text, int(n)) for n, text in each.items()} for each in row["ticks"]]
    said = [{int(n): str(text) for n, text in each.items()} for each in row.get("said", [{}] * len(ticks))]
    digests: Sequence[str] = row["digests"]
    if len(digests) != len(ticks) + 1 or len(said) != len(ticks):
        raise ValueError(f"{len(digests)} digests and {len(said)} rows of what was said, of {len(ticks)} ticks")
    return Episode(found, Rules(**row["rules"]), tuple(ticks), tuple(map(str, digests)), tuple(said))


def _read(text: str, agent: int) -> Step:
    """An instruction as it was tried: it need not be one that makes sense."""
    found = parse_steps(text)
    if isinstance(found, Diagnostic) or len(found) != 1:
        raise ValueError(f"`{text[:60]}` is not an instruction")
    return replace(found[0], agent=agent)
