"""Golden files of tests/golden: what something gives, kept until somebody means to change it."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).resolve().parent / "golden"


def short(value: object) -> str:
    """Twelve digits that stand for some bytes, or for how a value is printed."""
    data = value if isinstance(value, bytes) else full(value).encode()
    return hashlib.sha256(data).hexdigest()[:12]


def full(value: object) -> str:
    """Everything that a value has, as classes print it whose repr is not shortened for people."""
    kind = type(value).__qualname__
    if is_dataclass(value) and not isinstance(value, type):
        named = [each.name for each in fields(value) if each.repr]
        return f"{kind}({', '.join(f'{name}={full(getattr(value, name))}' for name in named)})"
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return f"{kind}({', '.join(f'{name}={full(getattr(value, name))}' for name in value._fields)})"
    if isinstance(value, (list, tuple)):
        inside = ", ".join(map(full, value))
        return f"[{inside}]" if isinstance(value, list) else f"({inside}{',' * (len(value) == 1)})"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{full(name)}: {full(each)}' for name, each in value.items())}}}"
    return repr(value)


def known(name: str) -> dict[str, Any]:
    """Return the content of a golden file; nothing where the file does not exist yet."""
    file = FOLDER / name
    found: dict[str, Any] = json.loads(file.read_text("utf-8")) if file.is_file() else {}
    return found


def compare(name: str, found: Mapping[str, object], part: str = "", others: bool = False) -> None:
    """Assert that a golden file, or a part of it, has just this; with HEARTH_REFRESH=1 it is written there.

    Args:
        name: of the file.
        found: what there is now.
        part: the field of the file that it is compared with; the whole file by default.
        others: whether there may be entries now that the file does not have.
    """
    now: dict[str, Any] = json.loads(json.dumps(found))
    if os.environ.get("HEARTH_REFRESH"):
        text = json.dumps(known(name) | {part: now} if part else now, indent=1, ensure_ascii=False, sort_keys=True)
        (FOLDER / name).write_text(text + "\n", "utf-8")
    expected = known(name)[part] if part else known(name)
    test = os.environ["PYTEST_CURRENT_TEST"].partition("::")[0]
    remedy = f"if it is right now: HEARTH_REFRESH=1 python -m pytest {test}"
    for entry, was in expected.items():
        assert now.get(entry) == was, f"{entry}: {remedy}"
    assert others or now.keys() == expected.keys(), remedy
