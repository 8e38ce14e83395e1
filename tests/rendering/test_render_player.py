"""The page beside a film, in a browser: it plays, and the step that goes on is highlighted."""

import shutil

import numpy as np
import pytest

from hearth.rendering.film.player import page
from hearth.rendering.film.video_file import Writer

STEPS = [
    {"tick": 0, "steps": [], "start": 0.0, "end": 1.0},
    {"tick": 1, "steps": ["[Walk] <bed> (1)"], "start": 1.0, "end": 2.0},
    {"tick": 2, "steps": ["[Lie] <bed> (1)"], "start": 2.0, "end": 3.0},
]
QUIET = ("--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
         "--disable-sync")  # fmt: skip


@pytest.fixture
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("no chromium: apt-get install chromium")
    with playwright.sync_playwright() as running:
        started = running.chromium.launch(executable_path=program, args=list(QUIET))
        yield started
        started.close()


@pytest.mark.tools
def test_the_film_plays_and_the_current_step_is_highlighted(browser, tmp_path):
    writer = Writer(tmp_path / "auto.webm", 64, 48, 10)
    for number in range(30):
        writer.add(np.full((48, 64, 3), 8 * number, np.uint8))
    writer.close()
    (tmp_path / "auto.html").write_text(page("Rest", ["auto.webm"], STEPS), encoding="utf-8")
    shown, faults = browser.new_page(), []
    shown.on("console", lambda message: faults.append(message.text) if message.type == "error" else None)
    shown.on("pageerror", lambda error: faults.append(str(error)))
    shown.goto((tmp_path / "auto.html").as_uri())
    shown.wait_for_function("document.querySelector('video').readyState >= 2")
    assert shown.evaluate("document.querySelector('video').videoWidth") == 64
    current = "[...document.querySelectorAll('li')].findIndex(step => step.hasAttribute('aria-current'))"
    assert shown.evaluate(current) == 0
    shown.evaluate("document.querySelector('video').play()")
    shown.wait_for_function("document.querySelector('video').currentTime > 0.2")
    shown.evaluate("document.querySelector('video').pause()")
    shown.click("li:nth-child(3)")
    shown.wait_for_function(f"{current} === 2")
    assert shown.evaluate("document.querySelector('video').currentTime") == pytest.approx(2.0, abs=0.2)
    assert not faults


def test_the_title_is_shown_as_text():
    html = page("<script>harm()</script> & tea", ["auto.webm"], STEPS)
    assert html.count("&lt;script&gt;harm()&lt;/script&gt; &amp; tea") == 2
    assert "<script>harm" not in html
