"""Pictures of the pages where people annotate: `python docs/hooks/annotate_pictures.py [FOLDER]`.

Without a folder they go to docs/pictures/web.

It needs the extra `web`, Playwright and Chromium. A server starts in an empty folder, and a program is written in it.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from shutil import which
from typing import Any

from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
TITLE = "Watch TV"
TEXT = "Look for the remote control, put the television on with it, sit down on the sofa and watch the film."
THINGS = ("sofa", "remote control", "television", "shower")
STEPS = (("Walk", "living room"), ("Find", "remote control"), ("Grab", "remote control"), ("Find", "television"),
         ("SwitchOn", "television"), ("SwitchOn", "television"), ("Walk", "sofa"), ("Sit", "sofa"),
         ("Watch", "television"))  # fmt: skip
VIEWS = (("", 1400, "light"), ("_narrow", 360, "dark"))
"""Ending of the file's name, width in pixels, colours."""

COLOURS = 96
"""Of a picture, so that it is small."""


@contextmanager
def served(folder: str) -> Iterator[str]:
    """The address of a server of its own."""
    command = [sys.executable, str(ROOT / "cli.py"), "serve", "--port", "0", "--json", "--out", folder]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, cwd=ROOT) as process:
        assert process.stdout is not None
        lines: list[str] = []
        while not lines or lines[-1] != "}\n":
            lines.append(process.stdout.readline())
            assert lines[-1], "the server ended"
        try:
            yield str(json.loads("".join(lines))["address"])
        finally:
            process.terminate()


def write_program(page: Any, address: str) -> str:
    """Begin, describe, set the scene and put the steps together, one of them twice; the address of the task."""
    page.goto(address)
    page.click("text=Begin with Annotate")
    page.goto(f"{address}/annotate/describe")
    page.fill("#title", TITLE)
    page.fill("#description", TEXT)
    page.click("text=Hand it in")
    page.goto(f"{address}/annotate/tasks")
    page.click(f"text={TITLE}")
    task = str(page.url)
    page.goto(f"{task}/scene")
    page.fill("#room-living_room", "1")
    for thing in THINGS:
        page.fill("#thing", thing)
        page.click("text=Add it")
    page.click("text=Go on to the program")
    page.click("#show-list")
    for action, thing in STEPS:
        page.select_option("#action", action)
        page.select_option("#slot-0", label=thing)
        page.click("#add-step button")
    page.locator("#state", has_text="Saved.").wait_for()
    return task


def take(page: Any, folder: Path, name: str) -> None:
    """A picture of the whole page in each of `VIEWS`."""
    for ending, width, scheme in VIEWS:
        page.set_viewport_size({"width": width, "height": 900})
        page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(400)
        file = folder / f"{name}{ending}.png"
        page.screenshot(path=file, full_page=True)
        Image.open(file).convert("RGB").quantize(COLOURS).save(file, optimize=True)
    page.emulate_media(color_scheme="light")


def annotate(page: Any, address: str, folder: Path) -> None:
    """The pages of the room Annotate."""
    task = write_program(page, address)
    room = f"{address}/annotate"
    pages = {"start": address, "annotate": f"{room}/", "describe": f"{room}/describe", "scene": f"{task}/scene"}
    for name, path in pages.items():
        page.goto(path)
        take(page, folder, name)
    page.set_viewport_size({"width": 1400, "height": 900})
    page.goto(f"{task}/compose")
    page.locator("#state", has_text="Saved.").wait_for()
    page.wait_for_timeout(500)
    take(page, folder, "compose")
    page.set_viewport_size({"width": 1400, "height": 900})
    page.click("#show-list")
    page.click("#steps li:nth-child(6) button:last-child")
    page.locator("#state", has_text="No faults").wait_for()
    page.select_option("#home", "maple")
    page.click("#run")
    page.wait_for_selector("#result .good")
    for _ in range(5):
        page.click("#on")
    take(page, folder, "run")


def main() -> None:
    """Take the pictures."""
    from playwright.sync_api import sync_playwright

    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs/pictures/web"
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as made, served(made) as address, sync_playwright() as playwright:
        program = which("chromium") or which("google-chrome")
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        annotate(browser.new_page(), address, folder)
        browser.close()


if __name__ == "__main__":
    main()
