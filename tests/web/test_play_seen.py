"""Play as a stranger sees it: news where one looks, the picture where one stands, words for what happened."""

from __future__ import annotations

import re

import pytest
from web.people import accessibility, watched
from web.playing import alone
from web.test_play_browser import begin, click, settled, tick_of

from hearth.web.play.play_trials import published

pytestmark = pytest.mark.tools

ALIVE = "#game button:not([disabled]):visible, #hands button:not([disabled])"


@pytest.fixture(params=[1400, 390])
def page(browser, request):
    """A page that is as wide as a desk's, or a telephone's."""
    faults = []
    made = watched(browser.new_context(viewport={"width": request.param, "height": 844}).new_page(), faults)
    made.set_default_timeout(60_000)
    yield made
    assert faults == []


def second(browser, server, link):
    """Return the page of another person after joining by a link."""
    other = browser.new_context(viewport={"width": 1000, "height": 800}).new_page()
    other.set_default_timeout(60_000)
    other.goto(link)
    assert "You were invited to a game" in other.inner_text("main")
    other.get_by_role("button", name="Begin").click()
    other.get_by_role("button", name="Join").click()
    other.wait_for_selector("#game[data-tick]")
    return other


def open_box(page):
    page.locator("#game .lists button.thing:not([disabled])").first.click()
    page.locator("#menu").wait_for()


def in_window(page, selector):
    return page.locator(selector).evaluate(
        "it => { const box = it.getBoundingClientRect(); return box.top >= 0 && box.bottom <= innerHeight; }"
    )


def is_over(page, words):
    """Assert that the end is said in the window, the box of a thing is gone, and nothing looks alive but two links."""
    page.locator("#said", has_text=words).wait_for()
    assert words in page.inner_text("#banner") and in_window(page, "#banner") and in_window(page, "#said")
    assert page.locator("#menu").is_hidden() and page.locator("#sure").is_hidden()
    assert page.locator(ALIVE).count() == 0
    page.locator("#plan .room").first.dispatch_event("click")
    assert page.locator("#menu").is_hidden()
    assert page.evaluate("document.activeElement.id") == "banner"


def finish(page):
    page.locator("#finish").click()
    page.locator("#sure").get_by_role("button", name="Finish").click()


def test_the_end_is_said_while_the_box_of_a_thing_is_open(served, page):
    begin(page, served)
    open_box(page)
    finish(page)
    is_over(page, "You finished this task after 0 steps. The goal was not reached.")
    assert accessibility(page) == []


def test_the_end_that_the_other_person_makes_is_said_too(served, browser, page):
    begin(page, served, helper="person")
    other = second(browser, served, page.locator("#banner a").get_attribute("href"))
    page.locator("#said", has_text="waits in that step").wait_for()
    open_box(page)
    page.locator("#finish").click()  # one is asked, while the other one finishes it
    other.locator("#finish").click()
    assert "for both of you" in other.inner_text("#sure")
    other.locator("#sure").get_by_role("button", name="Finish").click()
    is_over(page, "The other person finished this task after 0 steps, for both of you.")
    other.context.close()


def test_a_goal_that_is_reached_is_said_where_one_looks(served, page):
    task = published("wah", "test-1", 2)
    begin(page, served, "wah", 2)
    for tick, (act, _) in enumerate(alone(task)):
        click(page, act, tick)
    is_over(page, "Done: the goal is reached")
    assert page.locator("#banner a").first.inner_text() == "Choose another task"


def test_what_happened_stays_in_the_window(served, page):
    begin(page, served)
    page.locator("#things").scroll_into_view_if_needed()
    page.locator('[data-move="Turnleft"]').dispatch_event("click")
    page.locator("#said", has_text="You turned left.").wait_for()
    assert in_window(page, "#said") and in_window(page, "#clock")
    open_box(page)
    assert page.evaluate("menu.getBoundingClientRect().bottom <= news.getBoundingClientRect().top + 1")


def test_waiting_is_said_and_is_not_taken_for_the_act_before(served, page):
    begin(page, served, helper="random")
    page.locator('[data-move="Turnleft"]').click()
    page.locator("#said", has_text="You turned left.").wait_for()
    page.locator('[data-move=""]').click()
    page.locator("#said", has_text="You waited.").wait_for()
    assert "turned left" not in page.inner_text("#said").partition("The other")[0]


def test_why_one_can_not_walk_on_is_said(served, page):
    begin(page, served)
    for _ in range(12):
        if page.locator('[data-move="Walkforward"]').is_disabled():
            break
        tick = tick_of(page)
        page.keyboard.press("ArrowUp")
        page.wait_for_selector(f'#game[data-tick="{tick + 1}"]')
    tick = tick_of(page)
    page.keyboard.press("ArrowUp")
    assert "something is in the way" in page.inner_text("#said") and tick_of(page) == tick


def test_of_two_people_the_one_who_is_late_sees_the_clock_and_is_told(served, browser, page):
    begin(page, served, helper="person")
    assert "not here yet" in page.inner_text("#clock")
    other = second(browser, served, page.locator("#banner a").get_attribute("href"))
    assert "You help another person" in other.inner_text("#clock")
    page.locator("#banner", has_text="takes more than 15 seconds longer").wait_for()
    other.locator('[data-move="Turnleft"]').click()
    page.locator("#time", has_text=re.compile(r"^0:(1\d|0\d) to decide, then you wait\.$")).wait_for()
    assert in_window(page, "#time") and other.locator("#time").is_hidden()
    page.wait_for_selector('#game[data-tick="1"]')
    assert "You did not decide within 15 seconds, so you waited" in page.inner_text("#said")
    other.locator("#said", has_text="You turned left.").wait_for()
    assert page.locator("#time").is_hidden()
    other.context.close()


def test_what_was_seen_in_another_room_is_found(served, page):
    begin(page, served, sees="partial")
    here = page.locator("#furniture h3").first.inner_text()
    thing = page.locator("#furniture button.thing").first.inner_text().splitlines()[0]
    room = page.locator("#rooms button.thing:not([disabled])", has_text=re.compile("^(kitchen|living room|bathroom)"))
    away = next(each for each in room.all() if each.inner_text().splitlines()[0].lower() != here.lower())
    away.click()
    page.locator("#menu-actions").get_by_text("Go all the way", exact=True).click()
    settled(page)
    page.fill("#find", thing)
    found = page.locator("#furniture button.thing", has_text="last seen in")
    assert here.lower() in found.first.inner_text().lower() and found.first.is_disabled()
    page.fill("#find", "")
    page.select_option("#which", "goal")
    assert page.locator("#rooms button.thing").count() > 3, "rooms stay, to go to"


def test_a_thing_of_the_goal_says_so(served, page):
    begin(page, served, "owah", 0)
    wanted = page.locator("#things button.thing.wanted:not([disabled])").first
    wanted.click()
    assert "part of the goal" in page.inner_text("#menu-title")
    page.keyboard.press("Escape")
    page.locator("#things button.thing:not(.wanted):not([disabled])").first.click()
    assert "part of the goal" not in page.inner_text("#menu-title") and "clean" not in page.inner_text("#menu-title")


SLOW = """(() => { // a slow machine: one picture in a quarter of a second
  const usual = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (done) => setTimeout(() => usual(done), 260);
})()"""

ASTRAY = """() => {
  const { camera, to } = document.getElementById('game').view;
  const way = camera.getWorldDirection(to.way.clone());
  return camera.position.distanceTo(to.eye) + way.distanceTo(to.way);
}"""


def test_the_picture_ends_where_the_person_stands_however_slow_it_is(served, drawing):
    drawing.add_init_script(SLOW)
    drawing.set_default_timeout(120_000)
    begin(drawing, served, "owah", 0, interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]')
    for tick, move in enumerate(("Turnleft", "Turnright", "Turnleft", "Turnleft", "Turnright", "Turnright")):
        drawing.locator(f'[data-move="{move}"]').click()
        drawing.wait_for_selector(f'#view[data-tick="{tick + 1}"]')
        drawing.wait_for_timeout(1_500)
        assert drawing.evaluate(ASTRAY) < 0.001


def test_keys_of_the_view_work_wherever_one_pressed_last(served, drawing):
    drawing.set_default_timeout(120_000)
    begin(drawing, served, "owah", 0, interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]')
    drawing.locator("#plan .room").first.dispatch_event("click")
    drawing.locator("#menu").wait_for()
    drawing.keyboard.press("d")
    drawing.wait_for_selector('#view[data-tick="1"]')
    assert drawing.locator("#menu").is_visible()
    drawing.locator("#menu-actions button").first.focus()
    drawing.keyboard.press("Escape")
    assert drawing.locator("#menu").is_hidden()
    drawing.keyboard.press("a")
    drawing.wait_for_selector('#view[data-tick="2"]')
    drawing.wait_for_timeout(600)
    drawing.keyboard.press("t")
    drawing.locator("#view .mark").wait_for()
    label, frame = drawing.inner_text("#view .label"), drawing.locator("#view .mark").bounding_box()
    at = drawing.locator("#view canvas").bounding_box()
    assert label and frame["x"] >= at["x"] - 1 and frame["x"] + frame["width"] <= at["x"] + at["width"] + 7
    drawing.keyboard.press("Enter")
    assert drawing.inner_text("#menu-title").lower().startswith(label.lower().partition(" –")[0])
    drawing.keyboard.press("Escape")
    drawing.keyboard.press("q")
    assert "nothing that you could turn" in drawing.inner_text("#view .label")


def test_one_looks_up_and_down_by_buttons(served, drawing):
    drawing.set_default_timeout(120_000)
    begin(drawing, served, "owah", 0, interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]')
    height = "() => document.getElementById('game').view.look.pitch"
    for name, pitch in (("Look up", 10), ("Look down", 0)):
        drawing.get_by_role("button", name=name).click()
        assert drawing.evaluate(height) == pitch
    moves, picture = (drawing.locator(each).bounding_box() for each in (".view .moves", "#view"))
    assert 0 <= moves["y"] - picture["y"] - picture["height"] < 40, "buttons are under the picture"
