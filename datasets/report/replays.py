"""Runs of a dataset in 3D for its report: shapes of homes, and of the runs that are shown, as scripts."""

from collections.abc import Iterator, Mapping
from pathlib import Path

import orjson

from hearth.datasets.dataset import OWN, Dataset
from hearth.datasets.format.case_rows import rerun
from hearth.datasets.format.stored_cases import stored_cases
from hearth.datasets.verify import StoredHomes
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.optional_libraries import lacking
from hearth.storage.names import inside


def chosen(dataset: Dataset, most: int) -> list[str]:
    """Runs to be played: of each program one that runs to its end, those with films and pictures first."""
    if most < 1 or lacking("pictures"):
        return []
    query = f"""WITH seen AS (SELECT execution_id, 0 AS rank FROM videos UNION ALL SELECT execution_id, 1 FROM frames),
            ranked AS (SELECT execution_id, program_id, coalesce(r.rank, 2) AS rank FROM executions e
                LEFT JOIN (SELECT execution_id, min(rank) AS rank FROM seen GROUP BY 1) r USING (execution_id)
                WHERE executable AND {OWN}),
            firsts AS (SELECT min_by(execution_id, (rank, execution_id)) AS name, min(rank) AS rank FROM ranked
                GROUP BY program_id)
        SELECT name FROM firsts ORDER BY rank, name"""
    return [name for (name,) in dataset.rows(query, most)[1][:most]]


def write_replays(dataset: Dataset, to: Path, most: int) -> dict[str, tuple[int, int]]:
    """Write the data that the pages of runs play: `data/home-N.js` of each home, `data/replay-N.js` of each run.

    Args:
        dataset: whose runs they are.
        to: the report's folder.
        most: runs that are written, each of some 400 kB.

    Returns:
        Execution id -> the numbers of its home's file and its own. Runs in homes without geometry are left out.
    """
    names = chosen(dataset, most)
    if not names:
        return {}
    homes = StoredHomes(dataset)
    numbers: dict[str, int] = {}
    found: dict[str, tuple[int, int]] = {}
    for case in stored_cases(dataset, names):
        try:
            home = numbers.get(case["home"], len(numbers))
            data = dict(_written(dataset, homes, case, case["home"] not in numbers))
        except HearthError:
            continue
        numbers[case["home"]] = home
        found[case["execution_id"]] = (home, len(found))
        for kind, value in data.items():
            number = home if kind == "home" else len(found) - 1
            text = b"HEARTH.replays(%s, %d, %s);\n" % (orjson.dumps(kind), number, orjson.dumps(value))
            inside(to, f"data/{kind}-{number}.js").write_bytes(text)
    return found


def _written(
    dataset: Dataset, homes: StoredHomes, case: Mapping[str, object], new: bool
) -> Iterator[tuple[str, object]]:
    from hearth.rendering.film.replay_3d import home_shapes, run_shapes

    home = dataset.home(str(case["home"]))
    yield "replay", run_shapes(rerun(case, homes), home, dataset.knowledge)  # type: ignore[arg-type]
    if new:
        yield "home", home_shapes(home, dataset.knowledge)
