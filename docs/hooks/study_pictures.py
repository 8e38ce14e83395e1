"""Pictures of the pages of studies for the documentation: `python docs/hooks/study_pictures.py [--out docs/pictures]`.

Needs playwright, a Chromium and the extra `pictures`. Two films of `programs-by-lcs` are made, one person judges both,
another the first; the desk then shows them.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import orjson
import yaml
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parents[2]
CLI = str(ROOT / "cli.py")
VIEWS = (("", 1400, 800, "light"), ("-360-dark", 360, 780, "dark"))
"""Ending of the file's name, width and height in pixels, colours."""


def small_study(folder: Path) -> Path:
    """The study that ships, with two films for two people."""
    study: dict[str, Any] = yaml.safe_load((ROOT / "studies/programs-by-lcs.yaml").read_text("utf-8"))
    films = {**study["films"], "each": 1, "bands": study["films"]["bands"][::2]}
    file = folder / "study.yaml"
    file.write_text(yaml.safe_dump({**study, "name": "two-films", "people": 2, "repeats": 2, "films": films}), "utf-8")
    return file


def served(folder: Path, study: Path) -> tuple[subprocess.Popen[str], dict[str, Any]]:
    """A server, and what it printed of itself."""
    command = [sys.executable, CLI, "serve", "--port", "0", "--json", "--out", str(folder), "--study", str(study)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    text = ""
    assert process.stdout is not None
    while not text.endswith("\n}\n"):
        text += process.stdout.readline()
    return process, orjson.loads(text)


def to_films(page: Any, address: str) -> None:
    """A new person agrees, and reads what to look at."""
    page.goto(f"{address}/")
    page.get_by_role("button", name="Begin with Study").click()
    page.get_by_role("button", name="agree to take part").click()
    page.locator('form[action="/study/understood"] button').click()
    wait_for_film(page)


def wait_for_film(page: Any) -> None:
    """Until its middle is shown."""
    page.wait_for_selector("video")
    page.wait_for_function("document.querySelector('video').readyState > 1")
    page.evaluate("it => { it = document.querySelector('video'); it.currentTime = it.duration / 2 }")
    page.wait_for_timeout(1_000)


def judge(page: Any, value: int) -> None:
    """Answer, and go on."""
    page.locator(f'input[type=radio][value="{value}"]').check()
    page.get_by_role("button", name="Go on").click()


def take(browser: Any, about: dict[str, Any], out: Path) -> None:
    """Both pages, in each view."""
    first = browser.new_context().new_page()
    to_films(first, about["address"])
    judge(first, 4)
    for ending, width, height, scheme in VIEWS:
        size = {"width": width, "height": height}
        first.set_viewport_size(size)
        first.emulate_media(color_scheme=scheme)
        wait_for_film(first)
        first.evaluate("scrollTo(0, 0)")
        first.screenshot(path=out / f"study_film{ending}.png")
    judge(first, 2)
    to_films(second := browser.new_context().new_page(), about["address"])
    judge(second, 5)
    for ending, width, height, scheme in VIEWS:
        desk = browser.new_context(viewport={"width": width, "height": height}, color_scheme=scheme).new_page()
        desk.goto(about["desk"])
        desk.goto(f"{about['address']}/desk/study/")
        desk.screenshot(path=out / f"study_desk{ending}.png")


def main() -> None:
    """Take every picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs/pictures")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        study = small_study(Path(folder))
        kept = Path(folder, "served")
        subprocess.run([sys.executable, CLI, "study", "prepare", study, "--out", kept / "studies"], check=True)
        server, about = served(kept, study)
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        try:
            take(browser, about, asked.out)
        finally:
            browser.close()
            server.kill()


if __name__ == "__main__":
    main()
