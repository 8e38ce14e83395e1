"""A person's whole way through annotating, in a browser: by mouse, and by keyboard alone."""

from __future__ import annotations

import json
import re

import pytest

pytest.importorskip("playwright", reason="playwright is not installed: pip install playwright")

from playwright.sync_api import expect
from web.people import watched

from hearth.web.third_party_scripts import missing

pytestmark = pytest.mark.tools

TITLE = "Watch TV"
TEXT = "Go and look for the remote control, put the television on with it, sit down on the sofa and watch the film."
STEPS = (
    ("Go", "Walk to", "living room"), ("Go", "Find", "remote control"), ("Take and put", "Grab", "remote control"),
    ("Go", "Find", "television"), ("Open and switch", "Switch on", "television"), ("Go", "Walk to", "sofa"),
    ("Sit, lie, stand", "Sit on", "sofa"), ("Look", "Watch", "television"),
)  # fmt: skip
THINGS = ("sofa", "remote control", "television", "shower")
FORM = {"width": 1400, "height": 1100}


@pytest.fixture
def opened(browser, serving):
    """A server and a way to open its pages as a new person; nothing may be said in the console."""
    server, faults = serving(), []

    def person(**options):
        page = watched(browser.new_context(viewport=FORM, **options).new_page(), faults)
        page.goto(server.address)
        return page

    person.server, person.faults = server, faults
    yield person
    assert faults == []


def drag(page, source, target) -> None:
    """Drag from a point to a point, slowly enough that Blockly sees where it goes."""
    page.mouse.move(*source)
    page.mouse.down()
    page.mouse.move(source[0] + 30, source[1] + 5, steps=4)
    page.mouse.move(target[0] + 90, target[1], steps=8)  # beside the program, where no other slot catches it
    page.mouse.move(*target, steps=8)
    page.wait_for_timeout(60)
    page.mouse.up()
    page.wait_for_timeout(60)


def in_drawer(page, drawer, words):
    """Open a drawer; the point at the left edge of the block with these words."""
    page.locator(".blocklyToolboxCategory", has_text=re.compile(f"^{drawer}$")).click()
    page.wait_for_timeout(150)
    blocks = page.locator(".blocklyFlyout:visible .blocklyDraggable")
    for number in range(blocks.count()):
        if " ".join(blocks.nth(number).text_content().split()) == words:
            box = blocks.nth(number).locator("path").first.bounding_box()
            return box["x"] + 9, box["y"] + min(16, box["height"] / 2)
    raise AssertionError(f"no block {words} in {drawer}")


LAST = """() => {
    const workspace = Blockly.getMainWorkspace();
    let last = workspace.getBlocksByType("start")[0];
    while (last.getNextBlock()) last = last.getNextBlock();
    const area = last.pathObject.svgPath.getBoundingClientRect();
    const empty = last.inputList.find((input) => input.connection && !input.connection.targetBlock());
    const at = empty && Blockly.utils.svgMath.wsToScreenCoordinates(workspace, new Blockly.utils.Coordinate(
        empty.connection.x, empty.connection.y));
    return {type: last.type, x: area.left, y: area.bottom, slot: at ? [at.x, at.y] : null};
}"""


def put_block(page, drawer, words) -> None:
    last = page.evaluate(LAST)
    drag(page, in_drawer(page, drawer, words), (last["x"] + 11, last["y"] + 12))


def put_thing(page, words) -> None:
    x, y = page.evaluate(LAST)["slot"]
    drag(page, in_drawer(page, "Things", words), (x + 9, y))


def saved(page) -> None:
    expect(page.locator("#state")).to_contain_text("Saved.")


def describe(page) -> None:
    page.click("text=Describe an activity >> nth=-1")
    page.fill("#title", TITLE)
    page.fill("#description", TEXT)
    page.click("text=Hand it in")


def set_scene(page) -> None:
    page.click(f"text={TITLE}")
    page.click("main .button")
    page.fill("#room-living_room", "1")
    for thing in THINGS:
        page.fill("#thing", thing)
        page.click("text=Add it")
    page.click("text=Go on to the program")


@pytest.mark.skipif("blockly" in missing(), reason="no Blockly: make web")
def test_a_whole_way_by_mouse(opened):
    page = opened()
    page.click("text=Begin with Annotate")
    describe(page)
    page.goto(f"{opened.server.address}/annotate/tasks")
    set_scene(page)
    page.wait_for_selector(".blocklyToolbox")
    put_block(page, "Take and put", "Grab")
    put_thing(page, "shower")
    saved(page)
    assert page.locator("#steps .words").all_text_contents() == ["Grab …"], "the slot refused the shower"
    assert page.locator("#steps .fault").get_attribute("data-code") == "WRONG_ARITY"
    assert page.locator(".blocklySvg .faulty").count() == 1, "the fault is marked on its block"
    assert "not part of the program" in page.text_content("#loose")
    put_thing(page, "remote control")
    expect(page.locator("#steps .words")).to_have_text(["Grab remote control"])
    page.locator("#steps button[aria-label^='Take step 1 out']").click()
    expect(page.locator("#steps li")).to_have_count(0)
    for drawer, action, thing in STEPS:
        put_block(page, drawer, action)
        put_thing(page, thing)
    expect(page.locator("#steps .words")).to_have_text([f"{action} {thing}" for _, action, thing in STEPS])
    put_block(page, "Special", "Special:")
    page.locator("#blocks .blocklyEditableField").last.click()
    page.locator(".blocklyHtmlInput").fill("eat some crisps")
    page.keyboard.press("Enter")
    expect(page.locator("#steps .words").nth(8)).to_have_text("Special: eat some crisps")
    saved(page)
    page.select_option("#home", "maple")
    page.click("#run")
    page.wait_for_selector("#result .good")
    page.click("#on")
    assert page.locator(".ticks li[aria-current]").count() == 1
    page.click("#in-3d")
    page.wait_for_selector("canvas.replay[data-ready]", timeout=60_000)
    assert page.locator("canvas.replay").get_attribute("data-tick") == "1"
    page.click("#on")
    assert page.locator("canvas.replay").get_attribute("data-tick") == "2"
    assert len(set(page.locator("canvas.replay").screenshot())) > 100, "there is something to see"
    page.click("#submit")
    page.wait_for_url("**/annotate/tasks?thanks=yes")
    assert "your program is handed in" in page.text_content("main")


def tab_to(page, selector) -> None:
    """Press Tab until an element has the focus."""
    page.wait_for_selector(selector, state="attached")
    for _ in range(120):
        if page.evaluate("selector => document.activeElement?.matches(selector)", selector):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"{selector} can't be reached by Tab")


def choose(page, selector, text) -> None:
    """Choose in a menu by typing what it begins with, as one does."""
    tab_to(page, selector)
    wanted = page.evaluate(
        "([s, t]) => [...document.querySelector(s).options].findIndex(o => o.text === t)", [selector, text]
    )
    assert wanted >= 0, f"{text} is not offered"
    page.keyboard.press("Home")
    for _ in range(wanted):
        page.keyboard.press("ArrowDown")


def add_step(page, action, *things) -> None:
    choose(page, "#action", action)
    for number, thing in enumerate(things):
        choose(page, f"#slot-{number}", thing)
    tab_to(page, "#add-step button")
    page.keyboard.press("Enter")
    page.locator("#action").focus()


def test_a_whole_way_by_keyboard_alone(opened, tmp_path):
    page = opened()
    tab_to(page, "form button")
    page.keyboard.press("Enter")
    page.wait_for_url("**/annotate/")
    tab_to(page, "a[href='/annotate/describe']")
    page.keyboard.press("Enter")
    tab_to(page, "#title")
    page.keyboard.type(TITLE)
    tab_to(page, "#description")
    page.keyboard.type(TEXT)
    tab_to(page, "main button")
    page.keyboard.press("Enter")
    page.wait_for_selector(".good")
    tab_to(page, "main a[href='/annotate/']")
    page.keyboard.press("Enter")
    tab_to(page, "a[href='/annotate/tasks']")
    page.keyboard.press("Enter")
    tab_to(page, ".list a")
    page.keyboard.press("Enter")
    tab_to(page, "main .button")
    page.keyboard.press("Enter")
    tab_to(page, "#room-living_room")
    page.keyboard.type("1")
    for thing in THINGS:
        tab_to(page, "#thing")
        page.keyboard.type(thing)
        page.keyboard.press("Enter")
        page.wait_for_selector(f"#prop-{thing.replace(' ', '_')}")
    tab_to(page, "button[value=compose]")
    page.keyboard.press("Enter")
    page.wait_for_selector("#action option", state="attached")
    tab_to(page, "#show-list")
    page.keyboard.press("Enter")
    tab_to(page, "#action")
    page.select_option("#action", "Grab")  # what the slot offers, whatever is chosen above it
    assert page.locator("#slot-0 option").all_text_contents() == ["remote control"], "no shower"
    for _, action, thing in STEPS:
        add_step(page, f"{action} …", thing)
    add_step(page, "Switch on …", "television")
    saved(page)
    page.wait_for_selector("#steps li:last-child .fault[data-code=CONTRADICTION]")
    tab_to(page, "#steps li:last-child button:last-child")
    page.keyboard.press("Enter")
    tab_to(page, "#special")
    page.keyboard.type("eat some crisps")
    page.keyboard.press("Enter")
    written = [*(f"{action} {thing}" for _, action, thing in STEPS), "Special: eat some crisps"]
    expect(page.locator("#steps .words")).to_have_text(written)
    choose(page, "#home", "maple")
    tab_to(page, "#run")
    page.keyboard.press("Enter")
    page.wait_for_selector("#result .good")
    tab_to(page, "#submit")
    page.keyboard.press("Enter")
    page.wait_for_url("**/annotate/tasks?thanks=yes")
    reviewed_and_built(opened, tmp_path)


def composing(opened, **options):
    """A page that writes a program, by the list and the form."""
    page = opened(**options)
    page.click("text=Begin with Annotate")
    describe(page)
    page.goto(f"{opened.server.address}/annotate/tasks")
    set_scene(page)
    page.wait_for_selector("#action option", state="attached")
    page.click("#show-list")
    return page


def add(page, action, thing):
    page.select_option("#action", action)
    page.select_option("#slot-0", label=thing)
    page.click("#add-step button")


def test_a_special_block_with_a_picture_stops_no_saving(opened):
    page = composing(opened)
    page.fill("#special", "dance 💃")
    page.click("#add-special button")
    add(page, "Walk", "sofa")
    expect(page.locator("#state")).to_contain_text("Saved. Faults: 1.")
    expect(page.locator("#steps li").first.locator(".fault")).to_contain_text("leave out other signs")
    page.locator("#steps button[aria-label^='Take step 1 out']").click()
    expect(page.locator("#state")).to_contain_text("Saved. No faults.")
    page.reload()
    expect(page.locator("#steps .words")).to_have_text(["Walk to sofa"])


def test_a_second_tab_that_is_opened_takes_nothing_and_a_conflict_is_chosen(opened):
    page = composing(opened)
    add(page, "Walk", "sofa")
    saved(page)
    other = watched(page.context.new_page(), faults := [])
    other.goto(page.url)
    saved(other)
    add(page, "Sit", "sofa")
    saved(page)
    other.click("#show-list")
    add(other, "Find", "television")
    expect(other.locator("#state")).to_contain_text("another tab has changed this program")
    other.click("text=Keep what is here")
    saved(other)
    add(page, "Find", "remote control")
    expect(page.locator("#steps .words")).to_have_count(3)
    page.click("text=Take what the other tab has")
    saved(page)
    both = ["Walk to sofa", "Find television"]
    expect(page.locator("#steps .words")).to_have_text(both)
    page.reload()
    expect(page.locator("#steps .words")).to_have_text(both)
    assert [fault for fault in faults if "409" not in fault] == []
    opened.faults[:] = [fault for fault in opened.faults if "409" not in fault]


def test_what_could_not_be_saved_is_saved_once_the_server_answers(opened):
    page = composing(opened)
    page.context.set_offline(True)
    add(page, "Walk", "sofa")
    expect(page.locator("#state")).to_contain_text("tried again")
    page.context.set_offline(False)
    expect(page.locator("#state")).to_contain_text("Saved.", timeout=15_000)
    page.reload()
    expect(page.locator("#steps .words")).to_have_text(["Walk to sofa"])
    opened.faults[:] = [fault for fault in opened.faults if "INTERNET_DISCONNECTED" not in fault]


LOOK = """() => [...document.querySelectorAll("#blocks .blocklyText")].filter((each) => each.checkVisibility())
    .map((each) => { const look = getComputedStyle(each); return [look.fill, look.fontSize, look.fontFamily]; })"""


@pytest.mark.skipif("blockly" in missing(), reason="no Blockly: make web")
def test_blocks_stay_readable_when_the_colours_of_the_page_change(opened):
    page = composing(opened, color_scheme="light")
    add(page, "Walk", "sofa")
    page.click("#show-blocks")
    page.wait_for_selector("#blocks .blocklyText")
    before = page.evaluate(LOOK)
    for scheme in ("dark", "light"):
        page.emulate_media(color_scheme=scheme)
        page.wait_for_timeout(300)
        assert page.evaluate(LOOK) == before, f"as it was, in {scheme}"
    assert before and all(fill == "rgb(255, 255, 255)" for fill, _, _ in before)


def reviewed_and_built(opened, tmp_path) -> None:
    """The desk invites a second person, who passes the test, accepts the program, marks it and grades it."""
    desk, page = opened(), opened()
    desk.goto(opened.server.desk)
    desk.goto(f"{opened.server.address}/desk/annotate/")
    desk.click("text=Invite a reviewer")
    link = desk.input_value("#link")
    page.click("text=Begin with Annotate")
    page.click("text=Review programs")
    page.wait_for_selector("text=Reviewers are invited")
    page.goto(link)
    page.click("text=Become a reviewer")
    page.click("text=Take the test")
    for number in range(6):
        page.check(f"#{'yes' if number % 2 == 0 else 'no'}-{number}")
    page.click("text=Hand in the answers")
    page.click("text=Review programs")
    page.click(f"text={TITLE}")
    page.click("text=Accept it as it is")
    page.goto(f"{opened.server.address}/annotate/sketch")
    page.check("#keep-4")
    page.check("#keep-7")
    page.click("text=Keep it and go on")
    page.goto(f"{opened.server.address}/annotate/rate")
    page.check("#grade-1")
    page.click("text=Keep it and go on")
    assert "Nothing is left" in page.text_content("main")
    out = opened.server.out
    assert "[SwitchOn] <television> (1)" in (out / "programs.csv").read_text()
    assert json.loads((out / "sketches.json").read_text())["answer"][0][4] == 1
