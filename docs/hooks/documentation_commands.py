"""Follows a page of the documentation: writes its files, runs its commands, and checks what they print.

    python docs/hooks/documentation_commands.py docs/tutorial/*.md  # follow pages, and store the pictures in them

A fenced block with a title is a file; `bash` is run; `text` are successive lines of what was printed last, those after
`...` further below, and numbers of several digits may differ. A picture's title is the file that the commands wrote.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

ROOT = Path(__file__).resolve().parents[2]
FENCE = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.DOTALL | re.MULTILINE)
PICTURE = re.compile(r'!\[[^\]]*\]\((\S+) "([^"]+)"\)')
SECONDS = 900


def blocks(page: Path) -> list[tuple[str, str, str]]:
    """(language, title, text) of every fenced block."""
    return [(match[1], match[2] or "", match[3]) for match in FENCE.finditer(page.read_text("utf-8"))]


def pictures(page: Path) -> list[tuple[Path, str]]:
    """The pictures of a page that commands of it make: the file shown, and the file that they write."""
    return [((page.parent / shown).resolve(), made) for shown, made in PICTURE.findall(page.read_text("utf-8"))]


def follow(page: Path, folder: Path, checkout: Path = ROOT) -> Iterator[str]:
    """Do what a page says in a folder; gives each block of text that was not printed, with what was.

    Raises:
        AssertionError: a command failed.
    """
    printed = ""
    for language, title, text in blocks(page):
        if title:
            (folder / title).write_text(text, "utf-8")
        elif language == "bash":
            printed = ran(text, folder, checkout)
        elif language == "text" and not shown(text, printed):
            yield f"{text}\nis not in\n{printed}"


def ran(script: str, folder: Path, checkout: Path = ROOT) -> str:
    """Run a block as its reader would, `hearth` and `python` on the path; its output."""
    tools = folder.parent / "bin"
    tools.mkdir(exist_ok=True)
    for name, words in (("hearth", f'"{checkout / "cli.py"}"'), ("python", "")):
        (tools / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {words} "$@"\n')
        (tools / name).chmod(0o755)
    # In a copy the package is the copy, not the checkout that .venv knows.
    site = folder.parent / "site"
    site.mkdir(exist_ok=True)
    if not (site / "hearth").is_symlink():
        (site / "hearth").symlink_to(checkout)
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}", "PYTHONPATH": str(site)}
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", script], cwd=folder, env=environment, capture_output=True, text=True,
        timeout=SECONDS, check=False,
    )  # fmt: skip
    assert done.returncode == 0, f"{script}\n{done.stdout}\n{done.stderr}"
    return done.stdout + done.stderr


def shown(text: str, printed: str) -> bool:
    """Return whether the lines of a block are successive lines of the output, those after `...` further below.

    Numbers of several digits may differ.
    """
    lines = [_plain(line) for line in printed.splitlines() if line.strip()]
    at = 0
    for piece in re.split(r"^\.\.\.$", text, flags=re.MULTILINE):
        wanted = [_plain(line) for line in piece.splitlines() if line.strip()]
        found = next((n for n in range(at, len(lines) + 1) if lines[n : n + len(wanted)] == wanted), None)
        if found is None:
            return False
        at = found + len(wanted)
    return True


def _plain(line: str) -> str:
    return " ".join(re.sub(r"\d[\d,.]+", "N", line).split())


def main(pages: list[Path]) -> None:
    """Follow pages, and store their pictures."""
    for page in pages:
        with TemporaryDirectory() as name:
            folder = Path(name) / "here"
            folder.mkdir()
            for fault in follow(page, folder):
                print(f"{page}: {fault}", file=sys.stderr)
            for file, made in pictures(page):
                file.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(folder / made, file)
                print(f"{page}: {file.name}")


if __name__ == "__main__":
    main([Path(name) for name in sys.argv[1:]])
