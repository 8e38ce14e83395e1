"""Editing in a browser: old faults go, steps are changed and undone, hand-in asks, an unfinished text is kept."""

from __future__ import annotations

import pytest

pytest.importorskip("playwright", reason="playwright is not installed: pip install playwright")

from playwright.sync_api import expect
from web.people import watched
from web.test_annotate_browser import TEXT, TITLE, add, composing, opened, saved  # noqa: F401

from hearth.web.third_party_scripts import missing

pytestmark = pytest.mark.tools


def test_a_program_is_mended_step_by_step(opened):  # noqa: F811
    page = composing(opened)
    page.click("#submit")
    expect(page.locator("#refused")).to_contain_text("The program has no steps yet: add the first one.")
    opened.faults.clear()  # the browser notes the answer 400
    add(page, "Walk", "sofa")
    expect(page.locator("#refused")).to_be_empty()
    saved(page)
    page.locator("#steps button[aria-label^='Change step 1']").click()
    expect(page.locator("#form-title")).to_have_text("Change step 1")
    page.select_option("#slot-0", label="television")
    page.click("#keep-step")
    expect(page.locator("#steps .words")).to_have_text(["Walk to television"])
    expect(page.locator("#form-title")).to_have_text("Add a step")
    page.click("#undo")
    expect(page.locator("#steps .words")).to_have_text(["Walk to sofa"])
    page.click("#redo")
    expect(page.locator("#steps .words")).to_have_text(["Walk to television"])
    page.locator("#submit").focus()
    page.keyboard.press("Control+z")
    expect(page.locator("#steps .words")).to_have_text(["Walk to sofa"])
    page.select_option("#action", "Dance")
    assert "can't be run" in page.locator("#action option:checked").text_content()
    page.click("#add-step button")
    saved(page)
    page.click("#submit")
    expect(page.locator("#refused")).to_contain_text("It does not run in")
    page.click("#sure")
    page.wait_for_url("**/annotate/tasks?thanks=yes")


def test_a_description_that_was_not_handed_in_is_kept_and_counted(opened):  # noqa: F811
    page = opened()
    page.click("text=Begin with Annotate")
    page.click("text=Describe an activity >> nth=-1")
    page.fill("#title", TITLE)
    page.fill("#description", "x" * 2_100)
    expect(page.locator("#count")).to_contain_text("100 characters too many")
    page.fill("#description", TEXT)
    expect(page.locator("#count")).to_contain_text("of 2000 characters left")
    other = watched(page.context.new_page(), opened.faults)
    page.close()
    other.goto(f"{opened.server.address}/annotate/describe")
    expect(other.locator("#description")).to_have_value(TEXT)
    other.click("text=Hand it in")
    other.wait_for_selector("#kept")
    expect(other.locator("#description")).to_have_value("")


@pytest.mark.skipif("blockly" in missing(), reason="no Blockly: make web")
@pytest.mark.parametrize("width", [1400, 390])
def test_the_drawers_and_the_program_are_seen_whole(opened, width, tmp_path):  # noqa: F811
    page = composing(opened)
    add(page, "Walk", "living room")
    saved(page)
    page.set_viewport_size({"width": width, "height": 900})
    page.reload()
    page.wait_for_selector("#steps .words")
    page.click("#show-blocks")
    page.wait_for_selector(".blocklyToolboxCategory")
    page.locator("#blocks").screenshot(path=tmp_path / "blocks.png")
    frame = page.locator("#blocks").bounding_box()
    for drawn in page.locator("#blocks .blocklyDraggable").all():
        box = drawn.bounding_box()
        assert box["x"] >= frame["x"] and box["x"] + box["width"] <= frame["x"] + frame["width"], box
    row, label = page.locator(".blocklyToolboxCategory").first, page.locator(".blocklyToolboxCategoryLabel").first
    outer, inner = row.bounding_box(), label.bounding_box()
    assert outer["y"] <= inner["y"] and inner["y"] + inner["height"] <= outer["y"] + outer["height"] + 1


COLOURS = """() => ["#blocks .faulty > .blocklyIconGroup > .blocklyIconShape", "#blocks .blocklyEmboss > rect",
    "#blocks .blocklyBubbleText"].map((each) => getComputedStyle(document.querySelector(each)).fill)"""


@pytest.mark.skipif("blockly" in missing(), reason="no Blockly: make web")
def test_where_a_run_stops_is_red_and_steps_keep_their_numbers(opened):  # noqa: F811
    page = composing(opened)
    add(page, "Walk", "sofa")
    page.fill("#special", "hum a song")
    page.click("#add-special button")
    add(page, "Lie", "sofa")
    add(page, "Walk", "television")
    saved(page)
    page.click("#run")
    expect(page.locator("#result .fault")).to_contain_text("it stops at step 4")
    expect(page.locator("#result .fault")).to_contain_text("Stand up")
    expect(page.locator("#state")).to_have_text("Saved. The run stopped at step 4.")
    assert "faulty" in page.locator("#steps li").nth(3).get_attribute("class")
    page.click("#show-blocks")
    page.locator("#blocks .faulty > .blocklyIconGroup").click()
    page.wait_for_selector("#blocks .blocklyBubbleText")
    assert page.evaluate(COLOURS) == ["rgb(192, 22, 22)", "rgb(255, 248, 220)", "rgb(31, 29, 27)"]
    page.locator("#steps button[aria-label^='Take step 4 out']").click()
    saved(page)
    page.click("#run")
    expect(page.locator("#result .good")).to_contain_text("Left out, because they are in your own words: step 2.")
    expect(page.locator(".ticks li")).to_have_count(3)
    assert page.locator(".ticks li").evaluate_all("all => all.map((each) => each.value)") == [1, 2, 3]
    expect(page.locator(".ticks li").nth(1)).to_contain_text("Not done")
    page.locator("#steps button[aria-label^='Change step 1']").click()
    expect(page.locator("#blocks-view")).to_be_hidden()
    page.click("#leave-step")
    expect(page.locator("#blocks-view")).to_be_visible()
