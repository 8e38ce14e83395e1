"""The bill of materials: every library of the lock with its hashes, as CycloneDX JSON. It needs no network.

`make sbom` writes it into `dist/`; the same lock gives the same bytes.
"""

from __future__ import annotations

import json
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]

_PIN = re.compile(r"^([\w.-]+)(?:\[[\w,-]+\])?==([\w.!+]+)([^\\\n]*)((?: *\\\n +--hash=sha256:[0-9a-f]{64})+)", re.M)


def components(lock: str) -> list[dict[str, Any]]:
    """Return the libraries of a lock; one with several versions, by the version of Python, comes several times."""
    found = []
    for name, version, _, hashes in _PIN.findall(lock):
        known = re.findall(r"sha256:([0-9a-f]{64})", hashes)
        plain = re.sub(r"[-_.]+", "-", name).lower()
        files = [{"type": "distribution", "url": f"pkg:pypi/{plain}@{version}", "hashes": [_sha(one)]} for one in known]
        purl = f"pkg:pypi/{plain}@{version}"
        found.append({"type": "library", "name": plain, "version": version, "bom-ref": purl, "purl": purl,
                      "externalReferences": files})  # fmt: skip
    return found


def _sha(value: str) -> dict[str, str]:
    return {"alg": "SHA-256", "content": value}


def bill(lock: str, version: str) -> dict[str, Any]:
    """Return the bill of a lock for a version of Hearth."""
    whole = {"type": "application", "name": "hearth-home-programs", "version": version, "bom-ref": "hearth"}
    return {"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "metadata": {"component": whole},
            "components": components(lock)}  # fmt: skip


def main() -> None:
    """Write the bill of `requirements.lock` to the path of the first argument."""
    found = re.search(r'^VERSION = "([^"]+)"', (ROOT / "version.py").read_text("utf-8"), re.M)
    assert found is not None
    written = bill((ROOT / "requirements.lock").read_text("utf-8"), found[1])
    to = Path(sys.argv[1])
    to.parent.mkdir(parents=True, exist_ok=True)
    to.write_text(json.dumps(written, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
