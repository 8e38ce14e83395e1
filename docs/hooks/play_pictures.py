"""Pictures of the pages of Play for the documentation: `python docs/hooks/play_pictures.py [--out docs/pictures]`.

Needs playwright, a Chromium, and three.js (`make web`). Starts a server in a folder of its own and plays a few ticks.
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
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).resolve().parents[2]
FLAGS = ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader"]

PICTURES: dict[str, dict[str, Any]] = {
    "play": {"task": "1", "challenge": "owah", "helper": "nopa", "width": 1400, "scheme": "light"},
    "play-dark": {"task": "2", "challenge": "wah", "helper": "hp_true", "width": 1400, "scheme": "dark"},
    "play-360": {"task": "0", "challenge": "wah", "helper": "none", "width": 360, "scheme": "light"},
    "play-360-dark": {"task": "0", "challenge": "wah", "helper": "none", "width": 360, "scheme": "dark"},
    "play-3d": {"task": "0", "challenge": "wah", "helper": "hp_true", "width": 1400, "scheme": "light",
                "interface": "visual"},
    "play-3d-360": {"task": "0", "challenge": "wah", "helper": "hp_true", "width": 360, "scheme": "dark",
                    "interface": "visual"},
}  # fmt: skip
"""The game of each picture, and its camera and size."""


def take(page: Any, address: str, how: dict[str, Any], file: Path) -> None:
    """Begin a game, turn twice, open a menu, and take the picture."""
    page.goto(f"{address}/")
    page.locator('form[action="/begin"] button').first.click()
    page.goto(f"{address}/play/")
    form = page.locator(f'form:has(input[value="{how["challenge"]}"])')
    for name in ("task", "helper", "interface"):
        if name in how:
            form.locator(f"select[name={name}]").select_option(how[name])
    form.locator("button").click()
    page.wait_for_selector("#view[data-tick]" if "interface" in how else "#game[data-tick]", timeout=120_000)
    page.wait_for_timeout(500)
    for tick in (1, 2, 3):
        page.locator('[data-move="Turnleft"]').click()
        page.wait_for_selector(f'#game[data-tick="{tick}"]', timeout=60_000)
    if "interface" not in how:
        page.locator(".lists button.wanted:not([disabled]), .lists button:not([disabled])").first.click()
    page.wait_for_timeout(1500)
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=file)


def main() -> None:
    """Take every picture."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "docs/pictures")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        command = [sys.executable, str(ROOT / "cli.py"), "serve", "--port", "0", "--json", "--out", folder]
        server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        text = ""
        assert server.stdout is not None
        while not text.endswith("\n}\n"):
            text += server.stdout.readline()
        address = orjson.loads(text)["address"]
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        try:
            for name, how in PICTURES.items():
                size: Any = {"width": how["width"], "height": 1000 if how["width"] > 400 else 780}
                page = browser.new_context(viewport=size, color_scheme=how["scheme"]).new_page()
                take(page, address, how, asked.out / f"{name}.png")
        finally:
            browser.close()
            server.kill()


if __name__ == "__main__":
    main()
