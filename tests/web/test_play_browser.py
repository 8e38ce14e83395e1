"""Games in a Chromium: whole tasks by clicks, keys, two people, what is under the cursor, what is seen."""

from __future__ import annotations

import json
import random
import re
import shutil
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from web.people import accessibility, watched
from web.playing import alone

from hearth.kb.loading.load import default
from hearth.web.play import game_store
from hearth.web.play.live_games import LiveGame
from hearth.web.play.play_trials import published
from hearth.web.store import Store, default_url

pytestmark = pytest.mark.tools
SPLIT = {"wah": "test-1", "owah": "test"}
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def page(browser):
    faults = []
    made = watched(browser.new_context(viewport={"width": 1400, "height": 1000}).new_page(), faults)
    yield made
    assert faults == []


def begin(page, server, challenge="wah", task=0, **choices):
    page.goto(f"{server.address}/")
    if page.locator('form[action="/begin"]').count():
        page.locator('form[action="/begin"] button').first.click()
    page.goto(f"{server.address}/play/")
    form = page.locator(f'form:has(input[value="{challenge}"])')
    form.locator("select[name=task]").select_option(str(task))
    for name, value in choices.items():
        form.locator(f"select[name={name}]").select_option(value)
    form.locator("button").click()
    page.wait_for_selector("#game[data-tick]", timeout=60_000)
    return page.url.rpartition("/")[2]


def click(page, act, tick):
    """Do by clicks what a record has as `Grab 41`."""
    action, *ids = (act or "").split(" ")
    if not ids:
        page.locator(f'[data-move="{action}"]').click()
    else:
        page.locator(f'#game button.thing[data-id="{ids[0]}"]').first.click()
        page.locator(f'#menu-actions [data-instruction="{act}"]').click()
    page.wait_for_selector(f'#game[data-tick="{tick + 1}"]', timeout=30_000)


@pytest.mark.parametrize("challenge", ["wah", "owah"])
@pytest.mark.parametrize("number", range(5))
def test_each_kind_of_task_can_be_finished_by_clicks(serving, page, challenge, number):
    task = published(challenge, SPLIT[challenge], number)
    begin(page, serving(), challenge, number)
    for tick, (act, _) in enumerate(alone(task)):
        click(page, act, tick)
    page.wait_for_selector("#banner.good")
    assert "the goal is reached" in page.locator("#banner").text_content()
    assert page.locator("#goal li:not(.met)").count() == 0


def test_the_ten_tasks_are_of_ten_kinds():
    kinds = {(name, published(name, split, n).sets) for name, split in SPLIT.items() for n in range(5)}
    assert len(kinds) == 10


def tick_of(page):
    return int(page.get_attribute("#game", "data-tick"))


def press(page, thing, text):
    """Open the menu of a thing, press one of its buttons, and wait until that has done something."""
    tick = tick_of(page)
    page.locator(f'#game button.thing[data-id="{thing}"]').first.click()
    page.locator("#menu-actions button").get_by_text(text, exact=True).first.click()
    page.wait_for_selector(f'#game:not([data-tick="{tick}"])', timeout=30_000)


def offered(page, thing):
    button = page.locator(f'#game button.thing[data-id="{thing}"]').first
    if button.is_disabled():
        return []
    button.click()
    words = page.locator("#menu-actions button").all_text_contents()
    page.locator("#menu-close").click()
    return words


def settled(page):
    """Wait until the page asks for no more ticks."""
    before = -1
    while before != (before := tick_of(page)):
        page.wait_for_timeout(600)


KINDS = {"Go all the way", "One step towards it", "Open", "Close", "Take", "Put", "Switch on", "Switch off",
         "Sit down on"}  # fmt: skip


def kind_of(words):
    return next((kind for kind in sorted(KINDS, key=len, reverse=True) if words.startswith(kind)), words)


def test_every_button_of_the_page_does_something(serving, page):
    """Those of menus, a kind each; each move; what opens and closes the menu."""
    begin(page, serving(), "wah", 0, sees="full")
    pressed = set()
    for name in ("fridge", "mug", "coffee table", "couch"):
        button = page.locator("#game .lists button.thing:not([disabled])").filter(has_text=re.compile(f"^{name}"))
        thing = button.first.get_attribute("data-id")
        if "close" not in button.first.get_attribute("class").split():  # what is reached is not walked to
            press(page, thing, "Go all the way")
            pressed.add("Go all the way")
            settled(page)
        assert page.locator(f'#game .lists button.thing.close[data-id="{thing}"]').count() == 1, f"not at the {name}"
        for _ in range(12):
            left = [words for words in offered(page, thing) if kind_of(words) not in pressed]
            if not left:
                break
            press(page, thing, left[0])
            pressed.add(kind_of(left[0]))
    assert pressed == KINDS
    for move in ("StandUp", "", "Turnright", *["Turnleft"] * 12, "Walkforward"):
        if move == "Turnleft" and page.locator('[data-move="Walkforward"]').is_enabled():
            continue
        tick = tick_of(page)
        page.locator(f'[data-move="{move}"]').click()
        page.wait_for_selector(f'#game[data-tick="{tick + 1}"]', timeout=30_000)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [360, 1400])
def test_the_page_is_accessible_and_fits(serving, browser, scheme, width):
    page = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=scheme).new_page()
    begin(page, serving(), "owah", 1, helper="nopa")
    page.locator(".lists button.thing:not([disabled])").nth(8).click()
    assert accessibility(page) == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_the_keyboard_alone_will_do(serving, page):
    begin(page, serving())
    for tick, key in enumerate(("ArrowLeft", "ArrowRight", ".")):
        page.keyboard.press(key)
        page.wait_for_selector(f'#game[data-tick="{tick + 1}"]')
    button = page.locator("#furniture button:not([disabled])").first
    button.focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.parentElement.id") == "menu-actions"
    page.keyboard.press("Escape")
    assert page.evaluate("document.activeElement.dataset.id") == button.get_attribute("data-id")
    page.keyboard.press("Enter")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")  # one step towards it
    page.wait_for_selector('#game[data-tick="4"]')


def test_a_reloaded_page_goes_on(serving, page):
    begin(page, serving())
    page.keyboard.press("ArrowLeft")
    page.wait_for_selector('#game[data-tick="1"]')
    page.reload()
    page.wait_for_selector('#game[data-tick="1"]')
    page.keyboard.press("ArrowLeft")
    page.wait_for_selector('#game[data-tick="2"]')


def test_the_older_of_two_tabs_says_so(serving, page):
    begin(page, serving())
    other = page.context.new_page()
    other.goto(page.url)
    other.wait_for_selector("#game[data-tick]")
    page.keyboard.press("ArrowLeft")
    page.locator("#banner button").click()
    page.wait_for_selector("#banner", state="hidden")
    page.keyboard.press("ArrowLeft")
    page.wait_for_selector('#game[data-tick="1"]')
    other.wait_for_selector('#game[data-tick="1"]')


def test_two_people_in_two_browsers(serving, browser, page):
    """One waits for the other, both decide, one leaves and comes back; each page says so."""
    server = serving()
    begin(page, server, helper="person")
    link = page.locator("#banner a").get_attribute("href")
    assert page.locator('[data-move="Turnleft"]').is_disabled()
    page.keyboard.press(".")
    assert "not here yet" in page.inner_text("#said")
    other = browser.new_context().new_page()
    other.goto(f"{server.address}/")
    other.locator('form[action="/begin"] button').first.click()
    other.goto(link)
    other.get_by_role("button", name="Join").click()
    other.wait_for_selector("#game[data-tick]")
    page.locator("#banner", has_text="The other person is here").wait_for()
    assert page.locator("#banner a").count() == 0, "the invitation goes"
    page.keyboard.press("ArrowLeft")
    page.locator("#said", has_text="Waiting for the other person").wait_for()
    other.locator("#said", has_text="It is your turn").wait_for()
    page.keyboard.press("ArrowRight")  # has decided already
    assert "You have decided" in page.inner_text("#said")
    other.keyboard.press("ArrowRight")
    for each in (page, other):
        each.wait_for_selector('#game[data-tick="1"]')
    page.locator("#banner").wait_for(state="hidden")
    address = other.url
    other.goto("about:blank")
    page.locator("#banner", has_text="The other person has left").wait_for()
    since = time.monotonic()
    for tick in range(1, 6):
        page.keyboard.press("ArrowLeft")
        page.wait_for_selector(f'#game[data-tick="{tick + 1}"]')
    assert time.monotonic() - since < 5, "nobody waits for who has left"
    other.goto(address)
    page.locator("#banner", has_text="is back").wait_for()


@pytest.mark.skipif(shutil.which("node") is None, reason="node is not installed")
def test_a_program_in_another_language_helps(serving, page):
    begin(page, serving(), "wah", 0, helper="program")
    said = page.locator("#banner").text_content()
    port, token = said.split("port ")[1].split(" ")[0], said.split("token ")[1].rstrip(".")
    program = subprocess.Popen(["node", ROOT / "docs/examples/helper.js", port, token])
    try:
        time.sleep(3)
        for tick in range(8):
            page.keyboard.press("ArrowLeft")
            page.wait_for_selector(f'#game[data-tick="{tick + 1}"]', timeout=30_000)
    finally:
        program.kill()
    game = page.url.rpartition("/")[2]
    answer = page.request.get(f"{page.url}/episode.jsonl").text()
    acts = json.loads(answer.splitlines()[1])["actions"]
    assert game and any(helper is not None for _, helper in acts)


def test_what_is_under_the_cursor_is_what_our_renderer_shows(serving, drawing):
    """Ten views, 200 pixels each; those within two pixels of an edge are left out."""
    server = serving()
    chooser, equal = random.Random(1), 0
    for number in range(2):
        game = begin(drawing, server, "wah", number, helper="hp_true", interface="visual")
        drawing.wait_for_selector('#view[data-tick="0"]', timeout=60_000)
        live = _live(server, game)
        for view in range(5):
            tick = _walk_about(drawing, chooser) if view else 0
            ids = _ids(live, tick)
            rows, columns = np.nonzero(~_edges(ids))
            points = [(int(columns[n]), int(rows[n])) for n in chooser.sample(range(len(rows)), 200)]
            pick = "points => points.map(([x, y]) => document.getElementById('game').view.pick(x, y))"
            equal += sum(
                ids[y, x] == found for (x, y), found in zip(points, drawing.evaluate(pick, points), strict=True)
            )
    assert equal >= 0.99 * 2_000


def _live(server, game):
    store = Store(default_url(server.out))
    return LiveGame(store, store.read(lambda connection: game_store.stored(connection, game)), default())


def _walk_about(page, chooser):
    tick = int(page.get_attribute("#view", "data-tick"))
    page.focus("#view")
    for _ in range(3):
        page.keyboard.press(chooser.choice("ad"))
        tick += 1
        page.wait_for_selector(f'#view[data-tick="{tick}"]', timeout=30_000)
    page.wait_for_timeout(600)  # until the eyes are there
    return tick


def _ids(live, tick):
    game = live.sync()
    assert game.tick == tick
    found = live.drawn(default(), 0).sensor(game.playing.env, 0, ("instance_ids",))
    return found["instance_ids"].astype(int)


def _edges(ids):
    near = [np.roll(ids, (dy, dx), (0, 1)) for dy in range(-2, 3) for dx in range(-2, 3)]
    return np.any([each != ids for each in near], axis=0)


def test_a_thing_is_clicked_and_acted_on_in_3d(serving, drawing):
    begin(drawing, serving(), "wah", 0, interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]', timeout=60_000)
    box = drawing.locator("#view canvas").bounding_box()
    drawing.mouse.click(box["x"] + box["width"] * 0.3, box["y"] + box["height"] * 0.8)
    drawing.locator("#menu-actions button", has_text="One step").click()
    drawing.wait_for_selector('#view[data-tick="1"]', timeout=30_000)
    drawing.focus("#view")
    for key in ("ArrowUp", "t", "Enter"):
        drawing.keyboard.press(key)
    assert drawing.locator("#menu").is_visible()


@pytest.mark.parametrize("how", ["late", "lost"])
def test_the_view_in_3d_goes_on_whatever_becomes_of_its_models(serving, drawing, how):
    """A model that comes after others have gone, or never; an error that nobody catches fails the fixture."""

    def answered(route):
        if how == "lost":
            route.fulfill(status=404)
        else:
            drawing.wait_for_timeout(300)
            route.continue_()

    drawing.route("**/models/*.glb", answered)
    begin(drawing, serving(), "wah", 0, helper="hp_true", interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]', timeout=60_000)
    for _ in range(4):
        tick = tick_of(drawing)
        drawing.locator('[data-move="Turnleft"]').click()
        drawing.wait_for_selector(f'#game[data-tick="{tick + 1}"]', timeout=30_000)
    drawing.wait_for_selector(f'#view[data-tick="{tick_of(drawing)}"]', timeout=30_000)


def test_every_model_that_the_page_asks_for_is_there(serving, drawing):
    """Also when the game has gone on before the page asks: a helper that walks looks different in every tick."""
    refused = []
    busy = 503  # what does not come from a busy server is asked for again with the next tick
    drawing.on(
        "response", lambda found: refused.append(found.url) if found.status >= 400 and found.status != busy else None
    )
    drawing.route("**/models/*.glb", lambda route: (drawing.wait_for_timeout(200), route.continue_()))
    begin(drawing, serving(), "wah", 0, helper="hp_true", interface="visual", sees="full")
    drawing.wait_for_selector('#view[data-tick="0"]', timeout=60_000)
    drawing.focus("#view")
    drawing.keyboard.press("s")  # turns six times, as fast as the server answers
    drawing.wait_for_selector('#view[data-tick="6"]', timeout=60_000)
    assert refused == []


@pytest.mark.parametrize("way", ["g", "button"])
def test_a_task_is_finished_once_that_is_confirmed(serving, drawing, way):
    begin(drawing, serving(), "wah", 0, interface="visual")
    drawing.wait_for_selector('#view[data-tick="0"]', timeout=60_000)
    drawing.locator("#save").click()
    assert "saved" in drawing.inner_text("#said")

    def ask():
        if way == "g":
            drawing.focus("#view")
            drawing.keyboard.press("g")
        else:
            drawing.locator("#finish").click()
        drawing.locator("#sure").wait_for()

    ask()
    drawing.keyboard.press(".")  # no move of the game behind it
    drawing.keyboard.press("Escape")
    drawing.locator("#sure").wait_for(state="hidden")
    ask()
    drawing.get_by_role("button", name="Go on playing").click()
    drawing.locator('[data-move="Turnleft"]').click()
    drawing.wait_for_selector('#game[data-tick="1"]')
    ask()
    drawing.locator("#sure").get_by_role("button", name="Finish").click()
    drawing.locator("#banner", has_text="You finished this task after 1 step").wait_for()


def test_pictures_of_our_renderer_need_no_webgl(serving, page):
    begin(page, serving(), "wah", 0, interface="stream")
    page.wait_for_selector('#view[data-tick="0"]', timeout=90_000)
    page.wait_for_function("() => document.querySelector('#view img').naturalWidth === 640", timeout=60_000)
    box = page.locator("#view img").bounding_box()
    page.mouse.click(box["x"] + box["width"] * 0.3, box["y"] + box["height"] * 0.8)
    page.locator("#menu-actions button", has_text="One step").click(timeout=60_000)
    page.wait_for_selector('#view[data-tick="1"]', timeout=60_000)
