"""Pictures a second of the first-person view in headless Chromium, in software: `python benchmarks/play_frames.py`.

The view turns round for some seconds at 640x480, in each of the seven homes. Beside the pictures a second there is the
least time of a picture out of 60, finished and read back, which other work on the machine disturbs less. Needs
playwright, a Chromium and three.js (`make web`).
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
from pathlib import Path

from play_sessions import serve
from playwright.sync_api import sync_playwright

from hearth.challenges.published_tasks import tasks
from hearth.challenges.tasks import Task
from hearth.kb.loading.load import default
from hearth.web import sessions
from hearth.web.play import start_trial, trial_address
from hearth.web.play.play_trials import trial
from hearth.web.store import Store, default_url

FLAGS = ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader"]

LEAST = """() => {
  const view = document.getElementById("game").view;
  const gl = view.renderer.getContext();
  const times = Array.from({ length: 60 }, () => {
    const since = performance.now();
    view.look.yaw += 6;
    view.aim();
    view.renderer.render(view.scene, view.camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - since;
  }).sort((a, b) => a - b);
  return [times[0], times[30]];
}"""


def one_of_each_home() -> list[Task]:
    """A task in every home that Watch-And-Help has."""
    return list({each.home: each for split in ("train", "test-1") for each in tasks("wah", split)}.values())


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=4.0)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        store = Store(default_url(Path(folder)))
        session = sessions.start(store)
        process, address = serve(Path(folder))
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        try:
            page = browser.new_context(viewport={"width": 640, "height": 480}).new_page()
            page.context.add_cookies([{"name": "hearth", "value": session.token, "url": address}])
            for task in one_of_each_home():
                chosen = trial(task, default(), interface="visual")
                game = store.write(lambda connection, one=chosen: start_trial(connection, session.id, one))
                page.goto(address + trial_address(game))
                page.wait_for_selector("#view[data-tick]", timeout=120_000)
                page.locator("#view").scroll_into_view_if_needed()
                least, median = page.evaluate(LEAST)
                rates = [
                    page.evaluate("s => document.getElementById('game').view.measure(s)", asked.seconds) for _ in "abc"
                ]
                shown = ", ".join(f"{rate:.0f}" for rate in rates)
                print(f"{chosen.task.home}: {shown} pictures a second; one takes {least:.1f} to {median:.1f} ms")
        finally:
            browser.close()
            process.kill()
    print(f"load of this machine: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")


if __name__ == "__main__":
    main()
