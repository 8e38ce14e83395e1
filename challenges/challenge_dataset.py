"""A challenge as a dataset: tasks, demonstrations, episodes and trajectories as Parquet, with SQL views over them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import pyarrow as pa

from hearth.agents.online_helper_registry import ONLINE
from hearth.challenges import challenge_rows, published_tasks
from hearth.challenges.challenge_definition import VARIANTS, challenge
from hearth.challenges.demonstration_episodes import Demonstration, demonstrations
from hearth.challenges.episodes import Known, Record
from hearth.challenges.helper_beliefs import beliefs
from hearth.challenges.household import HouseholdTask
from hearth.challenges.household_as_challenge import OpenTask, as_task
from hearth.challenges.household_definition import NAME as HOUSEHOLD
from hearth.challenges.household_definition import settings
from hearth.challenges.household_task_workers import drawn_tasks
from hearth.challenges.result_files import Results, episode_data
from hearth.challenges.tasks import Task
from hearth.datasets.damage_faults import reading
from hearth.datasets.dataset import Dataset
from hearth.datasets.format.catalog import SQL
from hearth.schemas.agent_messages import read as read_message
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.goals import Goal
from hearth.schemas.numbers import number_of
from hearth.schemas.tables import comment_of, schema_of
from hearth.storage.duckdb_connections import limited, open_database, quoted, without_patterns
from hearth.storage.files import read_json, value_digest, write_bytes
from hearth.storage.manifest import NAME, describe
from hearth.storage.names import inside
from hearth.storage.parallel import Seen, unseen
from hearth.storage.partitions import write_table

STAGE = "challenge"

TABLES: dict[str, pa.Schema] = {
    name: schema_of(row)
    for name, row in {
        "tasks": challenge_rows.TaskRow,
        "demonstrations": challenge_rows.DemonstrationRow,
        "episodes": challenge_rows.EpisodeRow,
        "trajectories": challenge_rows.TrajectoryRow,
        "posteriors": challenge_rows.PosteriorRow,
    }.items()
}
"""Published tables by name; each is one file."""

CONSEQUENCE_TABLES = {
    name: schema_of(challenge_rows.HarmfulEpisodeRow, TABLES["episodes"]) if name == "episodes" else schema
    for name, schema in TABLES.items()
}
"""The tables of challenges by action set 3, whose episodes have counts of harm."""


def tables_of(name: object) -> dict[str, pa.Schema]:
    """Return the tables of a challenge, by its name."""
    harmful = name in VARIANTS and challenge(str(name)).consequences
    return CONSEQUENCE_TABLES if harmful else TABLES


SHOWN = 0.01
"""Probability from which on a predicate has a row in `posteriors`."""

VIEWS = {
    "demonstration_steps": (
        "SELECT task_id, s.tick, s.action, s.objects FROM "
        "(SELECT task_id, unnest(instructions) AS s FROM demonstrations)"
    ),
    "goal_predicates": (
        "SELECT task_id, split, g.predicate, g.count FROM (SELECT task_id, split, unnest(goal) AS g FROM tasks)"
    ),
}
"""Views over the tables, by name."""


def publish(
    folder: Path,
    name: str,
    known: Known,
    results: Sequence[Results] = (),
    limit: int | None = None,
    rate: float = 1.0,
    workers: int = 1,
    seen: Seen = unseen,
) -> dict[str, int]:
    """Write all tasks of a challenge with their demonstrations, and the episodes of some runs.

    Args:
        folder: gets the tables.
        name: of the challenge.
        known: gives the knowledge.
        results: runs whose episodes are written, too.
        limit: tasks of each split, at most.
        rate: of habits in demonstrations; 0 for clean ones.
        workers: processes.
        seen: called with the number of demonstrations done.

    Returns:
        The rows of each table.
    """
    tasks, shown = _household(results, limit, known, workers, seen) if name == HOUSEHOLD else _published(name, limit)
    rows: dict[str, Iterable[Mapping[str, Any]]] = {
        "tasks": map(_task, tasks),
        "demonstrations": shown
        or (_demonstration(each, rate) for each in demonstrations(tasks, known, rate, workers, seen)),
        "episodes": (_episode(found, each) for found, each in _once(results)),
        "trajectories": (row for found, each in _once(results) for row in _trajectory(found, each)),
        "posteriors": (row for found, each in _once(results) for row in _posterior(found, each, known)),
    }
    folder.mkdir(parents=True, exist_ok=True)
    counts = {}
    for table, schema in tables_of(name).items():
        whole = pa.Table.from_pylist(list(rows[table]), schema=schema)
        write_table(inside(folder, f"{table}.parquet"), whole)
        counts[table] = whole.num_rows
    write_bytes(folder / SQL, _sql("", tables_of(name)).encode())
    asked = {"stage": STAGE, "challenge": name, "rate": rate}
    describe(folder, asked, {}, value_digest(asked), rows=counts).write()
    return counts


def _published(name: str, limit: int | None) -> tuple[list[Task], list[challenge_rows.DemonstrationRow]]:
    """Return the tasks of all splits; their demonstrations are made apart."""
    parts = (*challenge(name).splits, *([published_tasks.DEMONSTRATIONS] if challenge(name).demonstrations else []))
    return [task for part in parts for task in published_tasks.tasks(name, part, limit=limit)], []


def _household(
    results: Sequence[Results], limit: int | None, known: Known, workers: int, seen: Seen
) -> tuple[list[Task], list[challenge_rows.DemonstrationRow]]:
    """Return household tasks, each with its expert's instructions.

    Without a limit these are the tasks of the results, where there are any: all 12,500 take hours to draw.
    """
    if results and limit is None:
        origins = {task.id: task.origin for found in results for task in found.header.suite.household}
    else:
        drawn = (drawn_tasks(split, limit, 0, known, workers, seen).tasks for split in settings()["splits"])
        origins = {task.id: task for some in drawn for task in some}
    return [*map(as_task, origins.values())], [*map(_expert, origins.values())]


def _expert(task: HouseholdTask) -> challenge_rows.DemonstrationRow:
    return {
        "task_id": task.id,
        "clean": True,
        "ticks": task.min_ticks,
        "instructions": [_instruction(tick, text) for tick, text in enumerate(task.expert) if text],
        "habits": [],
    }


def _sql(root: str, tables: Mapping[str, pa.Schema]) -> str:
    """Return the views of a folder, whose path is `root`; relative to it where that is empty."""
    lines = [f"CREATE VIEW {table} AS FROM read_parquet({quoted(f'{root}{table}.parquet')});" for table in tables]
    lines += [f"CREATE VIEW {name} AS {query};" for name, query in VIEWS.items()]
    for table, schema in tables.items():
        lines.append(f"COMMENT ON VIEW {table} IS {quoted(comment_of(schema))};")
        lines += [f"COMMENT ON COLUMN {table}.{each.name} IS {quoted(comment_of(each))};" for each in schema]
    return "\n".join(lines) + "\n"


class ChallengeData(Dataset):
    """A published challenge, opened for queries (see `datasets.dataset.Dataset.rows`)."""

    @classmethod
    def found(cls, path: Path) -> ChallengeData | None:
        """Return the published challenge of a folder; None where there is none."""
        content = read_json(path / NAME)
        published = isinstance(content, dict) and content.get("stage") == STAGE
        return cls(path, content) if published and isinstance(content, dict) else None

    @cached_property
    def _attached(self) -> Any:
        root = f"{self.folder.resolve()}/"
        for table in TABLES:  # a query would wait for a pipe
            path = inside(self.folder, f"{table}.parquet")
            if path.exists() and not path.is_file():
                remedy = "fetch or build the challenge again"
                raise HearthError.of(Code.DAMAGED_FILE, "is not a regular file", file=str(path), suggestion=remedy)
        with reading(self.folder):
            connection = open_database()
            tables = tables_of(self.manifest.get("challenge"))
            connection.execute(_sql(f"{without_patterns(self.folder)}/", tables))
            return limited(connection, root)

    @cached_property
    def _described(self) -> None:
        return None


def _task(task: Task) -> challenge_rows.TaskRow:
    grammar = challenge(task.challenge).grammar
    origin = task.origin if isinstance(task, OpenTask) else None
    goal = [*grammar.written(task.goal).items(), *((str(Goal(parts=(part,))), 1) for part in task.goal.parts)]
    return {
        "task_id": task.id,
        "challenge": task.challenge,
        "split": task.split,
        "home": task.home,
        "demonstration_home": task.demonstration_home,
        "sets": list(task.sets),
        "goal": [{"predicate": text, "count": number} for text, number in goal],
        "predicates": grammar.size(task.goal),
        "seed": task.seed,
        "instruction": task.instruction,
        "expert_ticks": origin.min_ticks if origin else None,
        "activity": origin.activity if origin else "",
    }


def _demonstration(shown: Demonstration, rate: float) -> challenge_rows.DemonstrationRow:
    return {
        "task_id": shown.task.id,
        "clean": rate == 0,
        "ticks": len(shown.actions),
        "instructions": [_instruction(tick, text) for tick, text in enumerate(shown.actions) if text is not None],
        "habits": [{"tick": tick, "name": name} for tick, name in shown.habits],
    }


def _instruction(tick: int, text: str) -> challenge_rows.InstructionRow:
    action, *objects = text.split(" ")
    nodes = [number for each in objects if (number := number_of(each)) is not None]
    if len(nodes) < len(objects):
        remedy = "`challenge verify` finds what is not as it was done"
        raise HearthError.of(Code.BAD_ARGUMENT, f"`{text[:60]}` is not an instruction", suggestion=remedy)
    return {"tick": tick, "action": action, "objects": nodes}


def episode_id(found: Results, record: Record) -> str:
    """Return the name of an episode: task, agents, seed."""
    lineup = found.header.lineup
    helper = f"{lineup.helper.rpartition('/')[2]}.{lineup.goal}" if record.helped else "alone"
    return f"{record.task}/{lineup.main}/{helper}/{record.seed}"


def _once(results: Sequence[Results]) -> Iterator[tuple[Results, Record]]:
    """All episodes; one that several files have, such as those without a helper, comes once.

    Raises:
        HearthError: DUPLICATE: two files have different episodes of one name.
    """
    known: dict[str, str] = {}
    for found in results:
        for each in found.records:
            name, content = episode_id(found, each), value_digest(episode_data(each))
            if name not in known:
                known[name] = content
                yield found, each
            elif known[name] != content:
                raise HearthError.of(Code.DUPLICATE, f"two files have another episode {name}", suggestion="give one")


def _episode(found: Results, record: Record) -> dict[str, Any]:
    lineup = found.header.lineup
    return {
        "episode_id": episode_id(found, record),
        "task_id": record.task,
        "main": lineup.main,
        "helper": lineup.helper if record.helped else "none",
        "goal": lineup.goal if record.helped else "none",
        "seed": record.seed,
        **record.metrics,
        "end": record.end["code"] if record.end else "",
    }


def _trajectory(found: Results, record: Record) -> Iterator[dict[str, Any]]:
    name = episode_id(found, record)
    for tick, texts in enumerate(record.actions):
        for agent, text in enumerate(texts):
            if text is not None and read_message(text) is None:
                yield {"episode_id": name, "agent": agent, **_instruction(tick, text)}


def _posterior(found: Results, record: Record, known: Known) -> Iterator[challenge_rows.PosteriorRow]:
    """Yield the beliefs of a helper that infers the goal; nothing for other helpers."""
    helper = found.header.lineup.helper
    if helper not in ONLINE or not record.helped or record.helper_goal is not None:
        return
    (task,) = (each for each in found.header.suite.tasks if each.id == record.task)
    name, believed = episode_id(found, record), beliefs(task, record, helper, known())
    for tick, moment in enumerate(believed.moments):
        for number, probability in enumerate(moment.wanted):
            if probability >= SHOWN:
                predicate, wanted = believed.predicates[number], believed.goal[number]
                yield {
                    "episode_id": name,
                    "tick": tick,
                    "predicate": predicate,
                    "probability": probability,
                    "wanted": wanted,
                }
