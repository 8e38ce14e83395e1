"""Every control of the pages of Play is used, at two widths, and does what it says."""

from __future__ import annotations

import re

import pytest
from web.people import accessibility
from web.used_controls import NARROW, WIDE, Record, fits, go, press, press_shape

from hearth.challenges.household import household_task
from hearth.schemas.spoken_words import spoken

pytestmark = [pytest.mark.tools, pytest.mark.parametrize("width", [WIDE, NARROW])]


@pytest.fixture(scope="module")
def records():
    return {WIDE: Record(), NARROW: Record()}


@pytest.fixture
def page(browser, served, records, width, request):
    failed = request.session.testsfailed
    with records[width].pages(browser, width, refused=REFUSED.get(request.function.__name__, ())) as context:
        made = context.new_page()
        made.set_default_timeout(60_000)
        made.goto(f"{served.address}/play/")
        press(made, made.get_by_role("button", name="Begin"))
        yield made
    if request.session.testsfailed == failed:
        records[width].ran.add(request.function.__name__)


REFUSED = {
    "test_a_third_person_is_told_that_the_game_is_full": ("",),
    "test_an_unknown_task_leads_back_to_the_form": ("/play/new",),
}


def begin(page, name="wah", **choices):
    """Fill the form of a challenge, and begin a game of it."""
    if not page.url.endswith("/play/"):
        page.goto(page.url.split("/play/")[0] + "/play/")
    for field, value in choices.items():
        control = page.locator(f"#{name}-{field}")
        control.fill(value) if field == "id" else control.select_option(value)
    press(page, page.locator(f"form[aria-labelledby={name}-title] button"))
    page.wait_for_selector("#game[data-tick]")
    assert fits(page)


def tick_of(page):
    return int(page.get_attribute("#game", "data-tick"))


def after(page, tick):
    page.wait_for_selector(f'#game[data-tick="{tick}"]')


def move(page, name):
    tick = tick_of(page)
    press(page, f'[data-move="{name}"]')
    after(page, tick + 1)


def thing(page, words):
    return page.locator("#game .lists button.thing:not([disabled])").filter(has_text=re.compile(f"^{words}"))


def test_each_choice_of_the_forms_is_kept(page):
    begin(page, "wah", task="1", helper="hp_true", interface="symbolic", sees="full")
    assert "everything" not in page.inner_text("#clock") and page.locator("#goal li").count()
    begin(page, "owah", task="1", helper="none", interface="symbolic", sees="partial")
    begin(page, "household", task="5", interface="symbolic", sees="full")
    begin(page, "household", id="household-train-00001")
    page.goto(page.url.split("/play/")[0] + "/play/")
    assert page.locator("table tbody tr").count() == 4 and fits(page)
    go(page, page.locator("table tbody a").first)
    page.wait_for_selector("#game[data-tick]")


def test_each_move_passes_a_tick(page):
    begin(page)
    for name in ("Turnleft", "Turnright", ""):
        move(page, name)
    for _ in range(12):
        if page.locator('[data-move="Walkforward"]').is_enabled():
            break
        move(page, "Turnleft")
    move(page, "Walkforward")


def test_each_action_of_the_menus_is_done(page):
    begin(page, sees="full")
    done = set()
    for name in ("fridge", "mug", "coffee table", "couch"):
        number = thing(page, name).first.get_attribute("data-id")
        at = f'#game .lists button.thing[data-id="{number}"]'
        if not page.locator(f"{at}.close").count():
            press(page, at)
            press(page, page.locator("#menu-actions").get_by_text("Go all the way", exact=True))
            page.locator(f"{at}.close").wait_for()
            _settled(page)
        while page.locator(at).is_enabled():
            press(page, at)
            left = [each for each in page.locator("#menu-actions [data-instruction]").all() if _kind(each) not in done]
            left.sort(key=lambda each: _kind(each) != "PutIn")
            if not left:
                press(page, "#menu-close")
                break
            done.add(_kind(left[0]))
            tick = tick_of(page)
            press(page, left[0])
            page.wait_for_selector(f'#game:not([data-tick="{tick}"])')
            assert "failed" not in page.inner_text("#said"), page.inner_text("#said")
    move(page, "StandUp")
    assert done >= {"Walktowards", "Open", "Close", "Grab", "PutBack", "SwitchOn", "SwitchOff", "Sit"}


def _kind(button):
    return button.get_attribute("data-instruction").split(" ")[0]


def _settled(page):
    before = -1
    while before != (before := tick_of(page)):
        page.wait_for_timeout(500)


def test_what_is_reached_is_not_walked_to_again(page):
    begin(page, sees="full")
    number = thing(page, "fridge").first.get_attribute("data-id")
    at = f'#game .lists button.thing[data-id="{number}"]'
    press(page, at)
    press(page, page.locator("#menu-actions").get_by_text("Go all the way", exact=True))
    _settled(page)
    tick = tick_of(page)
    press(page, at)
    assert page.locator("#menu-actions").get_by_text("Go all the way", exact=True).count() == 0
    press(page, "#menu-close")
    assert tick_of(page) == tick


def test_things_are_found_and_chosen_in_lists_and_on_the_plan(page):
    begin(page, sees="full")
    every = page.locator(".lists button.thing").count()
    page.fill("#find", "fridge")
    assert 0 < page.locator(".lists button.thing").count() < every
    page.fill("#find", "no such thing")
    assert page.locator("#none").is_visible(), "a filter that finds nothing says so"
    page.fill("#find", "")
    for choice in ("goal", "close"):
        page.select_option("#which", choice)
        assert page.locator(".lists button.thing").count() < every
    page.select_option("#which", "all")
    for shape in ("piece", "room", "door"):
        press_shape(page, f"#plan .{shape}")
        page.locator("#menu").wait_for()
        press(page, "#menu-close")
    assert accessibility(page) == []


def test_a_broken_ban_is_said(page):
    task = next(found for n in range(40) if (found := household_task(f"household-train-{n:05d}")).family == "without")
    name = spoken(task.goal.parts[0].goals[0].counts[0][0].terms[0])
    begin(page, "household", id=task.id, sees="full")
    ban = page.locator("#goal li", has_text=f"Never open the {name}")
    assert "kept so far" in ban.inner_text()
    at = f'#game .lists button.thing[data-id="{thing(page, name).first.get_attribute("data-id")}"]'
    if not page.locator(f"{at}.close").count():
        press(page, at)
        press(page, page.locator("#menu-actions").get_by_text("Go all the way", exact=True))
        page.locator(f"{at}.close").wait_for()
        _settled(page)
    press(page, at)
    press(page, page.locator("#menu-actions [data-instruction^=Open]"))
    page.locator("#banner", has_text="can't be reached any longer").wait_for()
    assert "broken" in ban.inner_text() and accessibility(page) == []
    press(page, "#finish")
    press(page, page.locator("#sure").get_by_role("button", name="Finish"))
    page.locator("#banner", has_text="something was done that the task forbids").wait_for()


def test_a_game_is_kept_and_finished(page):
    begin(page)
    press(page, "#save")
    assert "saved" in page.inner_text("#said")
    press(page, "#finish")
    press(page, page.get_by_role("button", name="Go on playing"))
    move(page, "Turnleft")
    press(page, "#finish")
    press(page, page.locator("#sure").get_by_role("button", name="Finish"))
    page.locator("#banner", has_text="You finished this task after 1 step").wait_for()
    assert page.locator("#save").is_disabled() and page.locator("#finish").is_disabled()
    with page.expect_download() as kept:
        press(page, page.locator("#banner").get_by_text("record"))
    assert kept.value.suggested_filename.endswith(".jsonl")
    assert go(page, page.locator("#banner").get_by_text("Choose another task")) == "Play"
    with page.expect_download():
        press(page, page.locator("table tbody td:last-child a"))


def test_two_people_meet_by_the_link(page):
    begin(page, helper="person")
    link, title = page.locator("#banner a"), page.inner_text("h1")
    address = link.get_attribute("href")
    press(page, "#banner button")
    page.locator("#banner button", has_text=re.compile("Copied|Marked")).wait_for()
    assert go(page, link) == title, "the person's own link leads back to the game"
    other = page.context.browser.new_context().new_page()
    other.goto(address)
    other.get_by_role("button", name="Begin").click()
    other.get_by_role("button", name="Join").click()
    page.locator("#banner", has_text="The other person is here").wait_for()
    other.context.close()


def test_one_who_was_invited_joins(page, served):
    inviting = page.context.browser.new_context().new_page()
    inviting.goto(f"{served.address}/play/")
    inviting.get_by_role("button", name="Begin").click()
    begin(inviting, helper="person")
    page.goto(inviting.locator("#banner a").get_attribute("href"))
    press(page, page.get_by_role("button", name="Join"))
    page.wait_for_selector("#game[data-tick]")
    inviting.context.close()


def test_a_third_person_is_told_that_the_game_is_full(page, served):
    people = [page.context.browser.new_context().new_page() for _ in range(2)]
    for each in people:
        each.goto(f"{served.address}/play/")
        each.get_by_role("button", name="Begin").click()
    begin(people[0], helper="person")
    link = people[0].locator("#banner a").get_attribute("href")
    page.goto(link)  # while there is a place
    people[1].goto(link)
    people[1].get_by_role("button", name="Join").click()
    press(page, page.get_by_role("button", name="Join"))
    page.get_by_role("alert").filter(has_text="Two people are in this game already").wait_for()
    page.goto(link)
    assert page.get_by_role("button", name="Join").count() == 0 and accessibility(page) == []
    assert go(page, page.get_by_role("link", name="Play alone")) == "Play"
    page.goto(link)
    assert go(page, page.get_by_role("link", name="Wait for somebody")) == "Play with somebody"
    press(page, page.get_by_role("button", name="Stop waiting"))
    for each in people:
        each.context.close()


def wait_for_somebody(page):
    assert go(page, page.get_by_role("link", name="Wait for somebody")) == "Play with somebody"
    page.locator("#waited", has_text="You have waited for 0:").wait_for()


def test_two_strangers_are_paired_and_one_of_them_leaves(page, served):
    wait_for_somebody(page)
    assert page.locator("#nobody").is_hidden() and fits(page) and accessibility(page) == []
    other = page.context.browser.new_context().new_page()
    other.goto(f"{served.address}/play/pair")
    other.get_by_role("button", name="Begin").click()
    for each in (page, other):
        each.wait_for_selector("#game[data-tick]", timeout=60_000)
    page.locator("#banner", has_text="The other person is here").wait_for()
    press(page, '[data-move="Turnleft"]')
    page.locator("#said", has_text="Waiting for the other person").wait_for()
    other.locator("#said", has_text="It is your turn").wait_for()
    other.click('[data-move="Turnright"]')
    after(page, 1)
    other.context.close()
    page.locator("#banner", has_text="The other person has left. You can go on").wait_for()
    for name in ("Turnleft", "Turnright", ""):
        move(page, name)


def test_who_is_paired_with_nobody_waits_for_somebody_else(page, served):
    """The other was paired, and has closed the page before the game was open."""
    other = page.context.browser.new_context().new_page()
    other.goto(f"{served.address}/play/")
    other.get_by_role("button", name="Begin").click()
    other.evaluate("fetch('/play/pair/look', {method: 'POST'})")
    wait_or_play = page.get_by_role("link", name="Wait for somebody")
    press(page, wait_or_play)
    page.wait_for_selector("#game[data-tick]", timeout=60_000)
    other.context.close()
    assert go(page, page.locator("#banner").get_by_role("link", name="Wait for somebody else")) == "Play with somebody"


def test_a_helper_stands_in_when_nobody_comes(page):
    def hurried(route):
        answer = route.fetch()
        found = answer.json()
        route.fulfill(json={**found, "patience": 2})

    page.route("**/play/pair/look", hurried)
    wait_for_somebody(page)
    page.locator("#nobody", has_text="Nobody has come yet").wait_for()
    assert go(page, page.get_by_role("button", name="Stop waiting")) == "Play"
    wait_for_somebody(page)
    go(page, page.get_by_role("button", name="Begin with a helper"))
    page.wait_for_selector("#game[data-tick]")
    assert "A helper is in the home" in page.inner_text("#clock")
    move(page, "Turnleft")


def test_the_older_tab_takes_over(page):
    begin(page)
    other = page.context.new_page()
    other.goto(page.url)
    other.wait_for_selector("#game[data-tick]")
    press(page, '[data-move="Turnleft"]')
    press(page, page.get_by_role("button", name="Go on here"))
    page.locator("#banner").wait_for(state="hidden")
    move(page, "Turnleft")


def test_the_home_is_looked_at_and_acted_in_by_pictures(page):
    begin(page, interface="stream")
    page.locator("#view img").wait_for()
    page.wait_for_function("() => document.querySelector('#view img').naturalWidth === 640", timeout=180_000)
    page.focus("#view")
    page.keyboard.press("a")
    after(page, 1)
    for key in ("t", "Enter"):
        page.keyboard.press(key)
    page.locator("#menu").wait_for()


def test_an_unknown_task_leads_back_to_the_form(page):
    page.fill("#household-id", "household-train-99999x")
    press(page, page.locator("form[aria-labelledby=household-title] button"))
    page.locator("[role=alert]").wait_for()
    said = page.inner_text("main")
    assert "BAD_ARGUMENT" not in said and "challenge tasks" not in said
    assert page.locator("#household-id").input_value() == "household-train-99999x"


def test_no_control_of_play_is_without_a_test(records, width):
    """Also: no button of all these tests changed nothing, and nobody reads what is for developers."""
    tests = {name for name in globals() if name.startswith("test_")} - {"test_no_control_of_play_is_without_a_test"}
    if missing := tests - records[width].ran:
        pytest.skip(f"not run, or failed: {', '.join(sorted(missing))}")
    assert [each for each in records[width].unused() if each.startswith("/play/")] == []
    assert sorted(records[width].dead) == []
    assert sorted(records[width].read) == []
