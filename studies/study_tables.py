"""The tables of a study: participants, trials, decisions, ratings; ids are salted, and there are no names."""

import io
import zipfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from hearth.analysis.episode_figure import ticks_of
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.tables import comment_of, schema_of
from hearth.storage.files import write_bytes
from hearth.storage.names import inside
from hearth.storage.partitions import write_table
from hearth.studies import study_rows
from hearth.studies.events import Event
from hearth.studies.films_to_judge import JudgedFilm, read_films
from hearth.studies.participant_flags import came, flags
from hearth.studies.study_codebook import codebook
from hearth.studies.study_folder import FILMS, Collected
from hearth.studies.study_progress import DONE, LEFT, Standing
from hearth.studies.study_trials import record_of, tasks_of

HELPER = 1
"""The number of the helper among the characters; the person is 0."""

TABLES: dict[str, pa.Schema] = {
    name: schema_of(row)
    for name, row in {
        "participants": study_rows.ParticipantRow,
        "trials": study_rows.StudyTrialRow,
        "decisions": study_rows.DecisionRow,
        "ratings": study_rows.RatingRow,
    }.items()
}
"""The tables of an export by name; each is one file."""


def export(collected: Collected, folder: Path) -> dict[str, int]:
    """Write the tables as Parquet into a folder, with their codebook; the number of rows of each."""
    folder.mkdir(parents=True, exist_ok=True)
    counts = {}
    for name, table in tables(collected).items():
        write_table(inside(folder, f"{name}.parquet"), table)
        counts[name] = table.num_rows
    write_bytes(inside(folder, "codebook.csv"), codebook(collected.study, TABLES))
    return counts


def archive(collected: Collected) -> bytes:
    """Return the tables as a zip archive, with the study's file and the meaning of every column."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as file:
        for name, table in tables(collected).items():
            written = io.BytesIO()
            pq.write_table(table, written, compression="zstd")
            file.writestr(zipfile.ZipInfo(f"{name}.parquet"), written.getvalue())
        file.writestr(zipfile.ZipInfo("study.yaml"), collected.study.text)
        file.writestr(zipfile.ZipInfo("columns.txt"), columns_in_words())
        file.writestr(zipfile.ZipInfo("codebook.csv"), codebook(collected.study, TABLES))
    return packed.getvalue()


def columns_in_words() -> str:
    """Return the meaning of every column."""
    lines = []
    for name, schema in TABLES.items():
        lines += [f"{name}: {comment_of(schema)}", *(f"  {each.name}: {comment_of(each)}" for each in schema), ""]
    return "\n".join(lines)


def tables(collected: Collected) -> dict[str, pa.Table]:
    """Return the tables by name."""
    rows = Rows(collected)
    every: dict[str, Iterator[Mapping[str, Any]]] = {
        "participants": rows.participants(),
        "trials": rows.trials(),
        "decisions": rows.decisions(collected.conduct.known()),
        "ratings": rows.ratings(),
    }
    return {name: pa.Table.from_pylist(list(every[name]), schema=schema) for name, schema in TABLES.items()}


class Rows:
    """The rows of a study's tables, in the order in which people joined."""

    def __init__(self, collected: Collected) -> None:
        self.collected, self.study = collected, collected.study
        conduct = collected.conduct
        self.standings = [conduct.standing(person) for person in collected.ledger.streams()]
        self.codes = {each.person: conduct.code(each.person) for each in self.standings}
        self.films: dict[tuple[int, str], JudgedFilm] = {}
        if self.study.films is not None and collected.folder is not None:
            found = read_films(collected.folder / FILMS)
            self.films = {(film.item, film.condition): film for film in found}

    def _head(self, standing: Standing) -> dict[str, Any]:
        participant = self.codes[standing.person]
        return {"study": self.study.name, "participant": participant, "simulated": self.collected.simulated}

    def platform_ids(self, person: str) -> list[str]:
        """Return the ids at the platform of all people but one."""
        others = (came(each) for each in self.standings if each.person != person)
        return [found["person"] for found in others if "person" in found]

    def participants(self) -> Iterator[Mapping[str, Any]]:
        """Yield a row for everybody."""
        for standing in self.standings:
            did = _of_kind(standing, "did")
            left = [each.data["why"] for each in _of_kind(standing, "left")]
            yield {
                **self._head(standing),
                "place": standing.place,
                "stage": standing.stage,
                "trials": len(did),
                "seconds": sum(each.data["seconds"] for each in did),
                "left": left[0] if left else "",
                "flags": list(flags(self.study, standing, self.platform_ids(standing.person))),
                "began": self.collected.conduct.joined_at(standing.person),
                "ended": standing.events[-1].at if standing.stage in (DONE, LEFT) else None,
            }

    def trials(self) -> Iterator[Mapping[str, Any]]:
        """Yield a row for every trial."""
        for standing in self.standings:
            for number, event in enumerate(_of_kind(standing, "did")):
                data = event.data
                record = data.get("record")
                metrics = record["metrics"] if record else {}
                end = record and record["end"]
                shown = ("success", "ticks", "length", "reward", "conflicts", "needless")
                yield {
                    **self._head(standing),
                    "counted": standing.finished,
                    "trial": number,
                    "task_id": tasks_of(self.study)[data["item"]].id if self.study.tasks else "",
                    **{name: data[name] for name in ("item", "condition", "repeat", "seconds")},
                    **{name: metrics.get(name) for name in shown},
                    "end": end["code"] if end else "",
                    "helper_fault": helper_fault(data),
                }

    def decisions(self, knowledge: Knowledge) -> Iterator[Mapping[str, Any]]:
        """Yield a row for each agent's attempt in each tick."""
        for standing in self.standings:
            for number, event in enumerate(_of_kind(standing, "did")):
                if "record" not in event.data:
                    continue
                _, ticks = ticks_of(
                    tasks_of(self.study)[event.data["item"]], record_of(event.data["record"]), knowledge
                )
                times = dict(enumerate(event.data.get("times", ())))
                for tick, done in enumerate(ticks):
                    for agent, step in sorted(done.instructions.items()):
                        failure = done.failures.get(agent)
                        yield {
                            **self._head(standing),
                            "trial": number,
                            "tick": tick,
                            "agent": agent,
                            "action": step.action,
                            "objects": [ref.node for ref in step.objects],
                            "failure": str(failure.code) if failure else "",
                            "seconds": times.get(tick),
                        }

    def ratings(self) -> Iterator[Mapping[str, Any]]:
        """Yield a row for every answer."""
        for standing in self.standings:
            for number, event in enumerate(_of_kind(standing, "answered")):
                yield from self._answers(standing, event, number)
            for event in _of_kind(standing, "finished"):
                yield from self._answers(standing, event, -1)

    def _answers(self, standing: Standing, event: Event, trial: int) -> Iterator[Mapping[str, Any]]:
        item, condition = event.data.get("item", -1), event.data.get("condition", "")
        film = self.films.get((item, condition))
        if trial >= 0:
            trial = _trial_of(standing, item, condition)
        for name, given in event.data["answers"].items():
            number = given if isinstance(given, int) else None
            yield {
                **self._head(standing),
                "counted": standing.finished,
                "trial": trial,
                "item": item,
                "condition": condition,
                "group": film.group if film else condition,
                "question": name,
                "value": number,
                "text": "" if number is not None else str(given),
            }


def helper_fault(data: Mapping[str, Any]) -> str:
    """Return the code of the helper's failure, if that ended a trial, by the data of its event; "" otherwise."""
    end = (data.get("record") or {}).get("end")
    return str(end["code"]) if end and end.get("agent") == HELPER else ""


def _of_kind(standing: Standing, kind: str) -> list[Event]:
    return [each for each in standing.events if each.kind == kind]


def _trial_of(standing: Standing, item: int, condition: str) -> int:
    """Return the number of the trial with a task under a condition; a person has it once."""
    did = _of_kind(standing, "did")
    return next(n for n, each in enumerate(did) if (each.data["item"], each.data["condition"]) == (item, condition))


def person_of(collected: Collected, given: str) -> str:
    """Return the person with an id of the tables, or with the id of a session.

    Raises:
        HearthError: UNKNOWN_ID: nobody of this id takes part.
    """
    for person in collected.ledger.streams():
        if given in (person, collected.conduct.code(person)):
            return person
    raise HearthError.of(Code.UNKNOWN_ID, f"nobody of the id `{given[:60]}` takes part")
