"""The check that what is made of a dataset is not written into it."""

from pathlib import Path

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.storage.chosen_files import followed


def check_outside(path: Path, folder: Path) -> None:
    """Refuse a place within a dataset's folder, by a link too.

    Raises:
        HearthError: UNWRITABLE.
    """
    if followed(path).is_relative_to(folder.resolve()):
        message = "this is a place in the dataset that is read, which stays as it was published"
        raise HearthError.of(Code.UNWRITABLE, message, file=str(path), suggestion="name a place outside of it")
