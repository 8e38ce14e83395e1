"""The settings of a build."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from hearth.kb.action_sets import USUAL
from hearth.kb.language.reading_modes import Fuzzy
from hearth.storage.query_time_limit import checked_seconds

DERIVED = "homes"
"""Folder of homes that come with the sources: scene graphs in the ingest stage; in the sample stage, homes derived from
stored start graphs."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The options of a build; a stage names those that its output depends on.

    Attributes:
        sources: files and folders to read, in order.
        out: the folder for one folder a stage.
        seed: seed of all random choices.
        limit: programs to read at most, and as many descriptions; None for all.
        columns: columns of tables, and keys of JSON, that hold fields of a record, as in `title=Task,program=Plan`.
        fuzzy: how far sentences may be from those that are known, a value of `Fuzzy`.
        strict: refuse programs with a step that was corrected or shortened.
        homes: names of the homes to sample in; empty for every home of the catalog.
        homes_folder: the user's own homes, laid over ours.
        kb_folder: the user's own knowledge, laid over ours.
        salt: hashed with worker ids; by default derived from the sources, so that it is never published.
        action_set: the number of the action set that programs are run by, 2 or 3; for a stage run alone None is that of
            the stages before it, and else 2.
        strength: how much augmenting perturbs and clears away, a name in `repair/perturbations.yaml`.
        variants: perturbed environments for each execution, at most.
        target: augmented programs in all; 0 for as many as `variants` gives.
        homes_each: homes to sample each program in, drawn from `homes`; 0 for all of them.
        tries: repairs of one program, at most.
        pictures: number of programs to picture, step by step.
        videos: number of them to film.
        clips: number of programs to film small, for clips.
        demonstrations: number of programs to picture from above with class masks, step by step.
        time_limit: seconds that a record may take in a stage; 0 for no limit. Records that take longer are tried again
            by the next build. Scanning a packed file may take a sixth of it, and half of it for each megabyte.
        store: URL of the store of which `out` is a local copy (see `storage.remote_build_folders`), or "".
        revision: the state of the store.
    """

    sources: tuple[str, ...] = ()
    out: str = "data_out"
    seed: int = 0
    limit: int | None = None
    columns: str = ""
    fuzzy: str = Fuzzy.TYPOS.value
    strict: bool = False
    homes: tuple[str, ...] = ()
    homes_folder: str | None = None
    kb_folder: str | None = None
    salt: str | None = None
    action_set: int | None = None
    strength: str = "mild"
    variants: int = 3
    target: int = 0
    homes_each: int = 0
    tries: int = 20
    pictures: int = 3
    videos: int = 0
    clips: int = 0
    demonstrations: int = 0
    time_limit: float = 60.0
    store: str = ""
    revision: str = ""

    def __post_init__(self) -> None:
        """Refuse a time limit that is none.

        Raises:
            HearthError: BAD_ARGUMENT.
        """
        checked_seconds(self.time_limit)

    def chosen(self, names: tuple[str, ...]) -> dict[str, Any]:
        """Return the named options, as stored in a manifest; of action set 2 nothing is said, as before there was 3."""
        values = asdict(self)
        found = {name: values[name] for name in names}
        if found.get("action_set") in (None, USUAL):
            found.pop("action_set", None)
        return found

    def folder(self, stage: str) -> Path:
        """Return the folder of a stage."""
        return Path(self.out) / stage
