"""Studies in a Chromium: a person's whole way, by mouse and by keyboard; the desk; accessible, and 360 px wide."""

from __future__ import annotations

import re
from dataclasses import asdict

import numpy as np
import pytest
from studies.small import SMALL
from studies.test_replays_to_judge import REPLAYED, with_replays
from web.people import accessibility, watched
from web.test_study_room import JUDGE

from hearth.storage.files import write_json
from hearth.studies.films_to_judge import JudgedFilm

pytestmark = pytest.mark.tools


@pytest.fixture
def page(browser):
    faults = []
    made = watched(browser.new_context(viewport={"width": 1400, "height": 1000}).new_page(), faults)
    made.set_default_timeout(60_000)
    yield made
    assert faults == []


def seen(page):
    """Check every page, in light and dark: nothing is wider than a telephone, nothing is hard to read."""
    page.set_viewport_size({"width": 360, "height": 800})
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
    page.set_viewport_size({"width": 1400, "height": 1000})
    found = []
    for scheme in ("dark", "light"):
        page.emulate_media(color_scheme=scheme)
        found += accessibility(page)
    return found


def go(page, name, role="button", **how):
    """Press a button, or follow a link, and wait for the page it leads to."""
    with page.expect_navigation():
        page.get_by_role(role, name=name, **how).click()


def agree(page, server):
    page.goto(f"{server.address}/")
    go(page, "Begin with Study")
    assert seen(page) == []
    go(page, "agree to take part")


def films(folder):
    pytest.importorskip("cv2")
    from hearth.rendering.film.video_file import Writer

    (folder / "films").mkdir(parents=True)
    made = [
        JudgedFilm(n, "written", f"{n:03d}-{b}", b, f"Title: Text {n}", "maple", 1 - n, []) for n, b in enumerate("ab")
    ]
    write_json(folder / "films.json", [asdict(film) for film in made])
    for film in made:
        writer = Writer(folder / "films" / f"{film.name}.webm", 320, 240, 5.0)
        for number in range(10):
            writer.add(np.full((240, 320, 3), 20 * number, np.uint8))
        writer.close()


def test_films_are_watched_and_judged_by_keyboard_alone(serving, page, tmp_path):
    (tmp_path / "study.yaml").write_text(JUDGE)
    films(tmp_path / "served" / "studies" / "judging")
    server = serving("--study", str(tmp_path / "study.yaml"))
    agree(page, server)
    for number in range(2):
        page.wait_for_selector("video")
        for _ in range(600):
            if page.evaluate("document.querySelector('video').readyState") > 1:
                break
            page.wait_for_timeout(100)
        assert page.locator("h1").inner_text() == f"Film {number + 1} of 2"
        assert page.evaluate("document.querySelector('video').videoWidth") == 320
        assert seen(page) == []
        page.locator("input[type=radio]").first.focus()
        page.keyboard.press("ArrowRight")
        with page.expect_navigation():
            page.keyboard.press("Enter")
    page.get_by_label("What else?").fill("Nothing.")
    go(page, "Finish")
    assert page.locator("h1").inner_text() == "Thank you"
    page.goto(server.desk)
    page.goto(f"{server.address}/desk/study/")
    assert "2 of 2" in page.locator("table").inner_text()
    assert seen(page) == []
    go(page, "Delete")
    assert "deleted" in page.locator("table").inner_text()
    session = page.context.request.get(f"{server.address}/study/")
    assert session.status == 401, "the session is gone"


def test_a_replay_in_3d_is_judged_by_keyboard_alone(serving, page, tmp_path):
    (tmp_path / "study.yaml").write_text(REPLAYED)
    with_replays(tmp_path / "served" / "studies")
    server = serving("--study", str(tmp_path / "study.yaml"))
    agree(page, server)
    for _ in range(2):
        page.wait_for_selector(".replay[data-ready][data-tick='0']", timeout=120_000)
        steps = int(page.inner_text("#tick").split(" of ")[1])
        assert page.locator("h1").inner_text().startswith("Film ") and page.get_by_text("Films done").count() == 1
        assert page.locator(".replay").evaluate("it => it.width / it.height") == pytest.approx(4 / 3, abs=0.02)
        assert seen(page) == []
        pictures = [page.locator(".replay").screenshot()]
        page.locator("#on").focus()
        for number in range(1, steps + 1):
            page.keyboard.press("Enter")
            page.wait_for_selector(f".replay[data-tick='{number}']")
        page.wait_for_timeout(1_000)
        pictures.append(page.locator(".replay").screenshot())
        page.locator(".replay").focus()
        page.keyboard.press("ArrowLeft")
        page.wait_for_timeout(200)
        pictures.append(page.locator(".replay").screenshot())
        assert len(set(pictures)) == 3, "the run goes on, and one looks from another side"
        page.locator("#play").focus()
        page.keyboard.press("Enter")
        page.wait_for_selector(f".replay[data-tick='{steps}']")
        page.locator("input[type=radio]").first.focus()
        page.keyboard.press("ArrowRight")
        with page.expect_navigation():
            page.keyboard.press("Enter")
    go(page, "Finish")
    assert page.locator("h1").inner_text() == "Thank you"


def test_a_person_practises_does_the_trials_and_rates_the_helper(serving, page, tmp_path):
    (tmp_path / "study.yaml").write_text(SMALL)
    server = serving("--study", str(tmp_path / "study.yaml"))
    agree(page, server)
    go(page, "I have read this")
    rated = 0
    for name in ("Practise", "Begin", "Begin"):
        assert seen(page) == []
        go(page, name, exact=True)
        page.wait_for_selector("#game[data-tick]")
        page.locator('[data-move="Turnleft"]').click()
        page.wait_for_selector('#game[data-tick="1"]')
        assert "hp_random" not in page.inner_text("main")
        page.locator("#finish").click()
        page.locator("#sure").get_by_role("button", name="Finish").click()
        go(page, "Go on", "link")
        if page.locator("legend").count() and "Last" not in page.locator("h1").inner_text():
            assert seen(page) == []
            page.get_by_text("6", exact=True).click()
            go(page, "Go on")
            rated += 1
    assert rated == 1
    assert page.locator("h1").inner_text() == "Last questions"
    go(page, "Finish")
    assert page.locator("h1").inner_text() == "Thank you"


def test_the_time_that_is_left_is_shown_and_kept(serving, page, tmp_path):
    """The clock runs; when it is over, so is the task, without a move of anybody."""
    (tmp_path / "study.yaml").write_text(SMALL.replace("practice: 1", "practice: 1\nlimits: {minutes: 0.15}"))
    server = serving("--study", str(tmp_path / "study.yaml"))
    agree(page, server)
    go(page, "I have read this")
    go(page, "Practise", exact=True)
    page.wait_for_selector("#time:not([hidden])")
    first = page.inner_text("#time")
    assert re.fullmatch(r"Time left: 0:0\d", first)
    page.locator('[data-move="Turnleft"]').click()
    page.wait_for_selector('#game[data-tick="1"]')
    assert seen(page) == []
    page.locator("#banner", has_text="The time is over, after 1 step").wait_for()
    assert page.inner_text("#time") < first and page.locator('[data-move="Turnleft"]').is_disabled()
