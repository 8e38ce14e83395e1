"""The researcher's token: unguessable, from the environment or made once for a folder."""

import os
import secrets
from pathlib import Path

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.web.store import private

COOKIE = "hearth_desk"
"""The cookie of a researcher who has entered the desk."""

VARIABLE = "HEARTH_DESK_TOKEN"
"""The environment variable with the token, for servers on many machines."""

SHORTEST = 20
"""Characters of a token that can't be guessed."""

TRIES = 5
"""Times that a token is made where the file has none."""


def desk_token(out: Path) -> str:
    """Return the token of the desk: the environment's, or that of a file which only its owner can read.

    Raises:
        HearthError: DAMAGED_FILE: the file has no token, however often it is made.
    """
    given = os.environ.get(VARIABLE, "")
    if len(given) >= SHORTEST:
        return given
    file = private(out) / "desk-token"
    for _ in range(TRIES):
        try:
            kept = file.read_text("ascii").strip()
        except FileNotFoundError:
            kept = _made(file)
        if len(kept) >= SHORTEST:
            return kept
        file.unlink(missing_ok=True)  # an earlier version could leave it empty
    raise HearthError.of(Code.DAMAGED_FILE, "it has no token", file=str(file), suggestion="delete it")


def _made(file: Path) -> str:
    """Return a new token in a file that appears whole; that of another server if this came second."""
    token, beside = secrets.token_urlsafe(32), file.with_name(f".{file.name}.{secrets.token_hex(8)}")
    descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(descriptor, "w") as opened:
            opened.write(token + "\n")
            opened.flush()
            os.fsync(opened.fileno())
        os.link(beside, file)
    except FileExistsError:
        return file.read_text("ascii").strip()
    finally:
        beside.unlink()
    return token
