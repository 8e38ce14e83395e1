"""Every format in which episodes are given to others who train agents on them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from hearth.challenges.result_files import Results
from hearth.challenges.task_files import Suite
from hearth.interop.chat_messages import Chats, messages
from hearth.interop.lerobot_export import lerobot
from hearth.interop.minari_export import minari
from hearth.kb.knowledge import Knowledge
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

FORMATS: dict[str, Callable[[Results, Path, int, Knowledge, int | None], int]] = {"minari": minari, "lerobot": lerobot}
"""Each writes the episodes of one agent of a run into a folder, and returns their number."""

MESSAGES = "messages"
"""The form of chats, which is also made of tasks that nobody has done."""


def export(results: Results, form: str, out: Path, agent: int, knowledge: Knowledge, limit: int | None = None) -> int:
    """Write the episodes of a run in one of `FORMATS`.

    Raises:
        HearthError: UNSUPPORTED_FILE: there is no such form; UNWRITABLE: the folder is not empty; those of the form.
    """
    if form not in FORMATS:
        remedy = ", ".join((*FORMATS, MESSAGES))
        raise HearthError.of(Code.UNSUPPORTED_FILE, f"unknown form `{form[:40]}`", suggestion=remedy)
    return FORMATS[form](results, new_folder(out), agent, knowledge, limit)


def export_messages(source: Results | Suite, out: Path, knowledge: Knowledge, limit: int | None = None) -> Chats:
    """Write chats for fine-tuning (see `chat_messages.messages`).

    Raises:
        HearthError: UNWRITABLE: the folder is not empty.
    """
    return messages(source, new_folder(out), knowledge, limit)


def new_folder(out: Path) -> Path:
    """Return a folder that is new or empty.

    Raises:
        HearthError: UNWRITABLE: it is neither.
    """
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        remedy = "name a new or empty folder"
        raise HearthError.of(Code.UNWRITABLE, "there is something already", file=str(out), suggestion=remedy)
    out.mkdir(parents=True, exist_ok=True)
    return out
