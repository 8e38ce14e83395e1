"""The salt of the last build of a folder, in a file of its owner: manifests, which are published, have none of it."""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
from pathlib import Path

NAME = ".salt"
"""A random number and the salt's hash with it, by a function that makes each guess slow; only its owner reads it."""


def salt_changed(out: Path, salt: str | None) -> bool:
    """Return whether the last build of a folder had another salt, given or not; the new one is kept.

    A salt that was not given follows from the sources, whose digests are in the key of the stage.

    Args:
        out: the folder of the build.
        salt: what was given; None if nothing was.
    """
    file = out / NAME
    kept = file.read_bytes() if file.is_file() else b""
    if salt is None:
        file.unlink(missing_ok=True)
        return bool(kept)
    if len(kept) > 16 and hmac.compare_digest(_hashed(kept[:16], salt), kept[16:]):
        return False
    out.mkdir(parents=True, exist_ok=True)
    number = secrets.token_bytes(16)
    file.unlink(missing_ok=True)
    with os.fdopen(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as opened:
        opened.write(number + _hashed(number, salt))
    return True


def _hashed(number: bytes, salt: str) -> bytes:
    return hashlib.scrypt(salt.encode("utf-8", "surrogatepass"), salt=number, n=2**14, r=8, p=1, dklen=32)
