"""Pictures and films of a dataset for its report: under names of ours, since a dataset could call one `index.html`."""

import shutil
from pathlib import Path, PurePosixPath

from hearth.datasets.dataset import Dataset
from hearth.schemas.diagnostics import HearthError
from hearth.storage.names import inside

FOLDER = "pictures"

_SHOWN = frozenset({".png", ".webm", ".mp4"})
_FILMED = (".webm", ".mp4")
_QUERY = "SELECT file FROM frames WHERE modality = 'rgb' UNION SELECT file FROM videos ORDER BY 1"


def shown_as(dataset: Dataset) -> dict[str, str]:
    """Return the report's name for each picture and film that the tables name and the folder holds."""
    found = [name for (name,) in dataset.rows(_QUERY)[1] if name and _source(dataset, name)]
    return {name: f"{FOLDER}/{number}{PurePosixPath(name).suffix}" for number, name in enumerate(found)}


_LOOKS = """SELECT e.program_id, p.file, p.film FROM
        (SELECT execution_id, file, false AS film, abs(tick - max(tick) OVER (PARTITION BY execution_id) * 0.6) AS away,
            camera = 'top' AS above FROM frames WHERE modality = 'rgb'
        UNION ALL SELECT execution_id, file, true, 0, false FROM videos) p
    JOIN executions e USING (execution_id) ORDER BY e.program_id, p.film, p.above, p.away, p.file"""


def pictured(dataset: Dataset) -> dict[str, tuple[str, bool]]:
    """Return by program id the report's name for a picture of the program, and whether there is a film.

    The name is "" if there are films only. The picture is of a step past its middle, not from above if possible.
    """
    ours = shown_as(dataset)
    found: dict[str, tuple[str, bool]] = {}
    for program, file, film in dataset.rows(_LOOKS)[1]:
        if file in ours:
            known, before = found.get(program, ("", False))
            found[program] = known or ("" if film else ours[file]), before or film
    return found


def copy_pictures(dataset: Dataset, to: Path) -> None:
    """Copy them into a report; of a film, the other form as well, where there is one."""
    for name, ours in shown_as(dataset).items():
        for suffix in _FILMED if name.endswith(_FILMED) else (PurePosixPath(name).suffix,):
            source = _source(dataset, str(PurePosixPath(name).with_suffix(suffix)))
            if source:
                target = inside(to, str(PurePosixPath(ours).with_suffix(suffix)))
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)


def _source(dataset: Dataset, name: str) -> Path | None:
    """Return the file of that name in a dataset; None where it is not a file in it, or not a picture."""
    try:
        path = inside(dataset.folder, name)
    except HearthError:
        return None
    return path if path.suffix in _SHOWN and path.is_file() else None
