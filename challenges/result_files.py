"""Result files: JSON lines. The first describes the run, each other is an episode with all its actions."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import blake2b
from itertools import islice
from pathlib import Path
from typing import Any

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.episode_agents import NOBODY, Lineup
from hearth.challenges.episodes import Record
from hearth.challenges.language_agents import are_transcripts, is_described
from hearth.challenges.metrics import HARMFUL, METRICS, Outcomes, by_task, metrics_of, summary
from hearth.challenges.task_files import Suite, read_suite, suite_data
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code
from hearth.schemas.numbers import LARGEST
from hearth.schemas.terminal import shown_line
from hearth.storage.input_files import read_input, read_lines
from hearth.version import VERSION

FORMAT = "hearth-results-1"

MOST_SEEDS = 1_000
"""Episodes of a task, at most."""


@dataclass(frozen=True)
class Header:
    """The description of a run.

    Attributes:
        suite: the tasks.
        lineup: the agents that took part; names only.
        seeds: episodes of each task, numbered from 0.
        version: of Hearth.
        episodes: task, seed and kind of those that there are; None where there are all. People do not do all.
        code: digest of the file of a user's own helper; "" for ours.
        language: the language models that took part, by the agent's number: model, prompt, protocol, settings.
    """

    suite: Suite
    lineup: Lineup
    seeds: int
    version: str = VERSION
    episodes: tuple[tuple[str, int, bool], ...] | None = None
    code: str = ""
    language: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    @property
    def helped(self) -> tuple[bool, ...]:
        """Return the kinds of episodes: without a helper, then with one, if there is one."""
        return (False,) if self.lineup.helper == NOBODY else (False, True)

    @property
    def keys(self) -> list[tuple[str, int, bool]]:
        """Task, seed and kind of every episode, in the order of the file."""
        return list(self.each_key())

    def each_key(self) -> Iterator[tuple[str, int, bool]]:
        """Yield the same keys one by one: a short file of a stranger may say that it has millions."""
        if self.episodes is not None:
            yield from self.episodes
            return
        yield from ((t.id, n, helped) for t in self.suite.tasks for n in range(self.seeds) for helped in self.helped)

    @property
    def count(self) -> int:
        """Return how many episodes there are."""
        if self.episodes is not None:
            return len(self.episodes)
        return len(self.suite.tasks) * self.seeds * len(self.helped)

    def as_json(self) -> dict[str, Any]:
        """Return the header as the first line has it."""
        agents: dict[str, Any] = {name: getattr(self.lineup, name) for name in ("main", "helper", "goal")}
        agents |= {"language": self.language} if self.language else {}
        return {
            "format": FORMAT,
            "hearth": self.version,
            "suite": suite_data(self.suite),
            "agents": {**agents, "code": self.code} if self.code else agents,
            "seeds": self.seeds,
            **({} if self.episodes is None else {"episodes": self.episodes}),
        }


class FileRecords(Collection[Record]):
    """The episodes of a file, read anew in each iteration: of many thousands not all fit in memory.

    A file that was replaced meanwhile raises the errors of `read`.
    """

    def __init__(self, header: Header, path: Path) -> None:
        self._header, self._path = header, path
        self._count = sum(1 for _ in self)

    def __iter__(self) -> Iterator[Record]:
        return read_records(self._header, islice(read_lines(self._path), 1, None), str(self._path))

    def __len__(self) -> int:
        return self._count

    def __contains__(self, record: object) -> bool:
        return any(each == record for each in self)


@dataclass(frozen=True)
class Results:
    """The results of a run.

    Attributes:
        header: the description of the run.
        records: its episodes.
    """

    header: Header
    records: Collection[Record]

    def outcomes(self, helped: bool) -> Outcomes:
        """Return the metrics of the episodes of one kind, by task."""
        return by_task((each.task, each.metrics) for each in self.records if each.helped == helped)

    def finished(self, helped: bool) -> Outcomes:
        """Return the same, without the episodes in which an agent could not go on: these are no scores."""
        return by_task((each.task, each.metrics) for each in self.records if each.helped == helped and each.end is None)

    def summary(self) -> dict[str, Any]:
        """Return all metrics as means over tasks, of the episodes in which every agent could go on."""
        return summary(self.finished(False), self.finished(True) if self.header.helped[-1] else {})

    @property
    def unfinished(self) -> list[Record]:
        """Return the episodes in which an agent could not go on."""
        return [each for each in self.records if each.end is not None]


def line(header: Header, record: Record) -> bytes:
    """Return an episode as a line, with a digest of itself and of its run's description."""
    import orjson

    data = episode_data(record)
    return shown_line(orjson.dumps({**data, "digest": _digest(header, data)})) + b"\n"


def first_line(header: Header) -> bytes:
    """Return the first line."""
    import orjson

    return orjson.dumps(header.as_json()) + b"\n"


def episode_data(record: Record) -> dict[str, Any]:
    """Return an episode as JSON."""
    return {
        "task": record.task,
        "seed": record.seed,
        "helped": record.helped,
        "helper_goal": record.helper_goal,
        "actions": record.actions,
        "final": record.final,
        "metrics": record.metrics,
        "end": record.end,
        **({} if record.language is None else {"language": record.language}),
    }


def _digest(header: Header, episode: Mapping[str, Any]) -> str:
    import orjson

    parts: list[Any] = [header.suite.digest, header.lineup.main, header.lineup.helper, header.lineup.goal, episode]
    parts += [header.language] if header.language else []
    return blake2b(orjson.dumps(parts, option=orjson.OPT_SORT_KEYS), digest_size=16).hexdigest()


def is_results(path: Path) -> bool:
    """Return whether a file begins as results do; other files are read as tasks."""
    import orjson

    try:
        first = orjson.loads(next(read_lines(path), b"") if path.is_file() else read_input(path).partition(b"\n")[0])
    except orjson.JSONDecodeError:
        return False
    return isinstance(first, dict) and first.get("format") == FORMAT


def read(path: Path) -> Results:
    """Return the results of a file; whether they are true, `verification` finds out.

    Raises:
        HearthError: MISSING_FILE, FILE_TOO_LARGE; BAD_JSON with the line; every fault of the tasks.
    """
    if path.is_file():
        header = read_header(next(read_lines(path), b""), str(path))
        return Results(header, FileRecords(header, path))
    first, *lines = read_input(path).splitlines() or [b""]
    header = read_header(first, str(path))
    return Results(header, tuple(read_records(header, lines, str(path))))


def read_header(data: bytes, file: str) -> Header:
    """Return the first line; errors as of `read`."""
    given = _mapping(data, file, 1)
    agents, seeds = given.get("agents"), given.get("seeds")
    if given.get("format") != FORMAT or not isinstance(agents, Mapping):
        remedy = "`challenge run TASKS --out FILE` writes one"
        raise HearthError.of(Code.BAD_JSON, f"not a file of results ({FORMAT})", file=file, suggestion=remedy)
    names = [agents.get(name) for name in ("main", "helper", "goal")]
    if not all(isinstance(name, str) and len(name) < 200 for name in names):
        raise HearthError.of(Code.BAD_JSON, "`agents` does not name main, helper and goal", file=file)
    if not isinstance(seeds, int) or isinstance(seeds, bool) or not 0 < seeds <= MOST_SEEDS:
        raise HearthError.of(Code.BAD_JSON, f"`seeds` is not a number from 1 to {MOST_SEEDS:,}", file=file)
    suite = read_suite(given.get("suite"), file)
    lineup, version = Lineup(str(names[0]), str(names[1]), str(names[2])), str(given.get("hearth"))[:40]
    code, language = str(agents.get("code", ""))[:64], agents.get("language", {})
    if not is_described(language):
        raise HearthError.of(Code.BAD_JSON, "`language` does not describe language models", file=file)
    episodes = _some_episodes(given.get("episodes"), suite, seeds, file)
    return Header(suite, lineup, seeds, version, episodes, code, language)


def _some_episodes(given: Any, suite: Suite, seeds: int, file: str) -> tuple[tuple[str, int, bool], ...] | None:
    """Return the episodes that a file names because it does not have all; None where it has."""
    if given is None:
        return None
    tasks = {task.id for task in suite.tasks}
    found = [tuple(each) for each in given if isinstance(each, list)] if isinstance(given, list) else []
    right = [key for key in found if [type(part) for part in key] == [str, int, bool]]
    if not right or right != list(dict.fromkeys(right)) or len(right) != len(given):
        raise HearthError.of(Code.BAD_JSON, "`episodes` is not a list of different [task, seed, helped]", file=file)
    if any(task not in tasks or not 0 <= seed < seeds for task, seed, _ in right):
        raise HearthError.of(Code.BAD_JSON, "`episodes` names a task or a seed that there is not", file=file)
    return tuple((task, seed, helped) for task, seed, helped in right)


def read_records(header: Header, lines: Iterable[bytes], file: str) -> Iterator[Record]:
    """Yield the episodes of the other lines.

    Errors are those of `read`, and DAMAGED_FILE where a line is not as it was written.
    """
    names = metrics_of(challenge(header.suite.challenge))
    for number, each in enumerate(lines, 2):
        given = dict(_mapping(each, file, number))
        written = given.pop("digest", None)
        record = episode_of(given)
        if record is None or record.metrics.keys() != names:
            raise HearthError(Diagnostic(Code.BAD_JSON, "not an episode", file, number))
        if written != _digest(header, episode_data(record)):
            message = "the episode is not as it was written: an action, a metric, a seed or the tasks were changed"
            raise HearthError(Diagnostic(Code.DAMAGED_FILE, message, file, number))
        yield record


def _mapping(data: bytes, file: str, number: int) -> Mapping[str, Any]:
    import orjson

    try:
        found = orjson.loads(data)
    except orjson.JSONDecodeError as error:
        raise HearthError(Diagnostic(Code.BAD_JSON, f"not JSON: {error}", file, number)) from error
    if not isinstance(found, dict):
        raise HearthError(Diagnostic(Code.BAD_JSON, "not a JSON object", file, number))
    return found


_FIELDS: dict[str, tuple[type, ...]] = {
    "task": (str,),
    "seed": (int,),
    "helped": (bool,),
    "helper_goal": (dict, type(None)),
    "actions": (list,),
    "final": (str,),
    "metrics": (dict,),
    "end": (dict, type(None)),
}
_LANGUAGE = "language"
"""The field that episodes of language models have besides."""


def episode_of(given: Mapping[str, Any]) -> Record | None:
    """Return an episode of JSON; None where it is not one."""
    if given.keys() - {_LANGUAGE} != _FIELDS.keys():
        return None
    if not all(isinstance(given[name], kinds) for name, kinds in _FIELDS.items()):
        return None
    if _LANGUAGE in given and not are_transcripts(given[_LANGUAGE]):
        return None
    actions = given["actions"]
    if not all(
        isinstance(tick, list) and all(each is None or isinstance(each, str) for each in tick) for tick in actions
    ):
        return None
    if not (_measured(given["metrics"]) and _counted(given["helper_goal"]) and _ended(given["end"])):
        return None
    if not 0 <= given["seed"] <= LARGEST:
        return None
    return replace(Record(**given), actions=tuple(map(tuple, actions)))


def _measured(metrics: Mapping[str, Any]) -> bool:
    """Return whether these are the metrics of an episode, as numbers that tables hold."""
    if metrics.keys() not in (METRICS, HARMFUL) or type(metrics["success"]) is not bool:
        return False
    counts = (value for name, value in metrics.items() if name not in ("success", "reward"))
    numbers = type(metrics["reward"]) in (int, float) and all(type(value) is int for value in counts)
    return numbers and all(abs(value) <= LARGEST for value in metrics.values())


def _counted(goal: Mapping[str, Any] | None) -> bool:
    """Return whether this is a goal in the words of a grammar, or none."""
    return goal is None or all(type(number) is int for number in goal.values())


def _ended(end: Mapping[str, Any] | None) -> bool:
    """Return whether this says by which failure an agent ended the episode, in plain values, or nothing."""
    return end is None or (
        isinstance(end.get("code"), str) and all(isinstance(value, (str, int)) for value in end.values())
    )
