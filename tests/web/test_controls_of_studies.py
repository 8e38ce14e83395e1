"""Every control of a participant's pages in a study is used, at two widths, and does what it says."""

from __future__ import annotations

import pytest
from studies.small import SMALL
from studies.test_replays_to_judge import REPLAYED, with_replays
from web.test_study_browser import films
from web.test_study_room import JUDGE
from web.used_controls import NARROW, WIDE, Record, go, press, seen

pytestmark = [pytest.mark.tools, pytest.mark.parametrize("width", [WIDE, NARROW])]

COMPLETION = "https://app.prolific.com/submissions/complete?cc=C1"
RECRUITED = f"recruitment: {{platform: prolific, completion: '{COMPLETION}'}}\n"


@pytest.fixture(scope="module")
def records():
    return {WIDE: Record(), NARROW: Record()}


@pytest.fixture
def opened(browser, serving, records, width, request, tmp_path):
    """A function that starts a study's server, and opens the link of a newcomer."""
    failed = request.session.testsfailed
    with records[width].pages(browser, width) as context:

        def start(text, prepared=None):
            (tmp_path / "study.yaml").write_text(text)
            if prepared:
                prepared()
            server = serving("--study", str(tmp_path / "study.yaml"))
            return server, visitor(context, server)

        yield start
    if request.session.testsfailed == failed:
        records[width].ran.add(request.function.__name__)


def visitor(context, server, link="/study/?PROLIFIC_PID=p1"):
    page = context.new_page()
    page.set_default_timeout(60_000)
    page.goto(f"{server.address}{link}")
    if page.get_by_role("button", name="Begin").count():
        press(page, page.get_by_role("button", name="Begin"))
        page.wait_for_selector("h1")
    return page


def button(page, name):
    return page.locator("main").get_by_role("button", name=name, exact=True)


def test_the_whole_way_of_a_study_that_is_played(opened):
    _, page = opened(SMALL + RECRUITED)
    page.route("https://app.prolific.com/**", lambda route: route.fulfill(body="<h1>Prolific</h1>"))
    seen(page)
    assert go(page, page.get_by_role("link", name="No, thank you")) == "You do not take part"
    go(page, page.get_by_role("link", name="Read it again"))
    go(page, page.get_by_role("link", name="the whole list"))
    page.go_back()
    assert go(page, page.locator("main").get_by_role("link", name="Your session")) == "Your session"
    page.go_back()
    assert go(page, page.get_by_role("button", name="agree to take part")) == "How it works"
    seen(page)
    assert go(page, button(page, "I have read this")) == "Practice"
    for name in ("Practise", "Begin", "Begin"):
        seen(page)
        go(page, button(page, name))
        page.wait_for_selector("#game[data-tick]")
        press(page, '[data-move="Turnleft"]')
        page.wait_for_selector('#game[data-tick="1"]')
        press(page, "#finish")
        press(page, page.locator("#sure").get_by_role("button", name="Finish"))
        go(page, page.locator("#banner").get_by_role("link", name="Go on"))
        if page.locator("legend").count() and "Last" not in page.locator("h1").inner_text():
            seen(page)
            press(page, page.get_by_text("6", exact=True))
            go(page, button(page, "Go on"))
    seen(page)
    press(page, page.get_by_label("young"))
    page.get_by_label("What else?").fill("It was fine.")
    assert go(page, button(page, "Finish")) == "Thank you"
    seen(page)
    go(page, page.locator("main").get_by_role("link", name="your session"))
    page.go_back()
    assert go(page, page.get_by_role("link", name="Go back to Prolific")) == "Prolific"
    assert page.url == COMPLETION


def test_who_stops_is_told_what_is_kept(opened):
    _, page = opened(SMALL)
    go(page, page.get_by_role("button", name="agree to take part"))
    go(page, button(page, "I have read this"))
    press(page, "summary")
    go(page, page.locator("main").get_by_role("link", name="your session"))
    page.go_back()
    if not button(page, "Stop taking part").is_visible():
        press(page, "summary")
    assert go(page, button(page, "Stop taking part")) == "You have stopped taking part"
    seen(page)
    assert go(page, page.locator("main").get_by_role("link", name="your session")) == "Your session"


def test_films_are_judged_and_a_full_study_says_so(opened, tmp_path):
    server, page = opened(JUDGE, lambda: films(tmp_path / "served" / "studies" / "judging"))
    go(page, page.get_by_role("button", name="agree to take part"))
    seen(page)
    page.locator("video").focus()
    page.keyboard.press("Space")
    for number in range(2):
        assert page.locator("h1").inner_text() == f"Film {number + 1} of 2"
        press(page, page.get_by_text("4", exact=True))
        go(page, button(page, "Go on"))
    assert page.locator("h1").inner_text() == "Last questions"
    press(page, page.locator("textarea"))
    page.keyboard.type("Nothing.")
    go(page, button(page, "Finish"))
    browser = page.context.browser
    second = visitor(browser.new_context(), server)
    go(second, second.get_by_role("button", name="agree to take part"))
    press(second, "summary")
    assert go(second, button(second, "Stop taking part")) == "You have stopped taking part"
    third = visitor(browser.new_context(), server)
    go(third, third.get_by_role("button", name="agree to take part"))
    page.context.clear_cookies()
    page.goto(f"{server.address}/study/")
    go(page, page.get_by_role("button", name="Begin"))
    assert "All places in this study are taken" in page.inner_text("main")
    go(page, page.get_by_role("link", name="Look again"))
    seen(page)


def test_replays_are_looked_at_from_all_sides(opened, tmp_path):
    _, page = opened(REPLAYED, lambda: with_replays(tmp_path / "served" / "studies"))
    go(page, page.get_by_role("button", name="agree to take part"))
    page.wait_for_selector(".replay[data-ready][data-tick='0']", timeout=120_000)
    press(page, "#on")
    page.wait_for_selector(".replay[data-tick='1']")
    press(page, "#back")
    page.wait_for_selector(".replay[data-tick='0']")
    press(page, "#play")
    page.wait_for_selector(".replay[data-tick='1']")
    seen(page)


def test_no_control_of_studies_is_without_a_test(records, width):
    """Also: no button of all these tests changed nothing, and nobody reads what is for developers."""
    tests = {name for name in globals() if name.startswith("test_")} - {"test_no_control_of_studies_is_without_a_test"}
    if missing := tests - records[width].ran:
        pytest.skip(f"not run, or failed: {', '.join(sorted(missing))}")
    assert [each for each in records[width].unused() if each.startswith("/study/")] == []
    assert sorted(records[width].dead) == []
    assert sorted(records[width].read) == []
