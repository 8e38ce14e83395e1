"""The researcher's token: unguessable, from the environment or made once for a folder."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from hearth.web.store import private

COOKIE = "hearth_desk"
"""The cookie of who has entered the desk."""

VARIABLE = "HEARTH_DESK_TOKEN"
"""The environment variable with the token, for servers on many machines."""

SHORTEST = 20
"""Characters of a token that can't be guessed."""


def desk_token(out: Path) -> str:
    """The token of the desk: the environment's, or that of a file which only its owner can read."""
    given = os.environ.get(VARIABLE, "")
    if len(given) >= SHORTEST:
        return given
    file = private(out) / "desk-token"
    try:
        descriptor = os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        return file.read_text("ascii").strip()
    with os.fdopen(descriptor, "w") as opened:
        token = secrets.token_urlsafe(32)
        opened.write(token + "\n")
    return token
