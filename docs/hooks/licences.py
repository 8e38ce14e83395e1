"""The page of licences, `docs/licences.md`: what pip-licenses finds in an environment that has all locks.

python docs/hooks/licences.py PIP_LICENSES      # `make licences` makes the environment, and calls it
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/licences.md"
LOCKS = {
    "requirements.lock": "Hearth with its extras and its tests",
    "requirements-tools.lock": "`make test-tools`",
    "requirements-transformers.lock": "The server of transformers that `make test-tools` asks",
}

ABOUT = """\
# Licences of libraries

None of these is part of Hearth; each is installed separately. `make licences` writes this page from the libraries' own
metadata. `make sbom` writes a bill of materials with versions and licences in CycloneDX.

PyTorch (the extra `models`) is in no lock: BSD-3-Clause.
"""

LONGEST = 120
"""Letters of a licence's name; some libraries give its whole text."""


def locked(lock: str) -> list[str]:
    """The names of a lock, as indexes write them."""
    names = re.findall(r"^([\w.-]+)(?:\[[^]]*\])?==", (ROOT / lock).read_text("utf-8"), re.M)
    return sorted({re.sub(r"[-_.]+", "-", name).lower() for name in names})


def short(licence: str) -> str:
    """The name of a licence on one line."""
    return " ".join(licence.partition("\n")[0].replace("|", "/").split())[:LONGEST]


def page(found: Sequence[dict[str, str]]) -> str:
    """The page, of rows of pip-licenses."""
    by_name = {re.sub(r"[-_.]+", "-", row["Name"]).lower(): row["License"] for row in found}

    def lines() -> Iterator[str]:
        yield ABOUT
        for lock, about in LOCKS.items():
            yield from (f"## {about}", "", f"`{lock}`", "", "| library | licence |", "|---|---|")
            for name in locked(lock):
                licence = by_name.get(name, "of another platform or Python than this page was written on")
                yield f"| {name} | {short(licence)} |"
            yield ""

    return "\n".join(lines()).rstrip() + "\n"


def main(tool: str) -> None:
    """Write the page."""
    words = [tool, "--from=mixed", "--format=json", "--with-system"]
    rows = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
    PAGE.write_text(page(rows), "utf-8")
    print(PAGE.relative_to(ROOT))


if __name__ == "__main__":
    main(sys.argv[1])
