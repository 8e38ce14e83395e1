"""Every control of the pages of Annotate, the desk and the session is used, at two widths, and does what it says."""

from __future__ import annotations

import pytest
from studies.small import SMALL
from web.test_annotate_browser import TEXT, TITLE
from web.used_controls import NARROW, WIDE, Record, button, go, link, press, seen

pytestmark = [pytest.mark.tools, pytest.mark.parametrize("width", [WIDE, NARROW])]


@pytest.fixture(scope="module")
def records():
    return {WIDE: Record(), NARROW: Record()}


@pytest.fixture
def served(serving, tmp_path):
    (tmp_path / "study.yaml").write_text(SMALL)
    return serving("--study", str(tmp_path / "study.yaml"))


@pytest.fixture
def page(browser, served, records, width, request):
    failed = request.session.testsfailed
    with records[width].pages(browser, width) as context:
        made = context.new_page()
        made.set_default_timeout(60_000)
        made.goto(f"{served.address}/annotate/")
        press(made, made.get_by_role("button", name="Begin"))
        made.wait_for_selector("h1")
        yield made
    if request.session.testsfailed == failed:
        records[width].ran.add(request.function.__name__)


def describe(page, title=TITLE, text=TEXT):
    page.fill("#title", title)
    page.fill("#description", text)
    go(page, button(page, "Hand it in"))


def to_composer(page):
    """From the task list to the page where a program is written."""
    go(page, page.locator(".list a").first)
    go(page, link(page, "Set the scene"))
    page.fill("#room-living_room", "1")
    for thing in ("sofa", "remote control", "television"):
        page.fill("#thing", thing)
        go(page, button(page, "Add it"))
    go(page, button(page, "Go on to the program"))
    page.wait_for_selector("#action option", state="attached")
    press(page, "#show-list")


def add(page, action, thing):
    page.select_option("#action", action)
    page.select_option("#slot-0", label=thing)
    press(page, "#add-step button")


def saved(page, text="Saved."):
    page.locator("#state", has_text=text).wait_for()


STEPS = (("Walk", "living room"), ("Walk", "sofa"), ("Sit", "sofa"))


def handed_in(page, served):
    page.goto(f"{served.address}/annotate/describe")
    describe(page)
    page.goto(f"{served.address}/annotate/tasks")
    to_composer(page)
    for action, thing in STEPS:
        add(page, action, thing)
    saved(page)
    press(page, "#submit")
    page.wait_for_url("**/annotate/tasks*")


def reviewer(page, served):
    """A second person, invited by the desk and qualified."""
    desk = page.context.browser.new_context().new_page()
    desk.goto(served.desk)
    desk.goto(f"{served.address}/desk/annotate/")
    desk.get_by_role("button", name="Invite a reviewer").click()
    address = desk.input_value("#link")
    desk.context.close()
    page.goto(address)
    assert go(page, button(page, "Become a reviewer")).startswith("Review")
    go(page, link(page, "Take the test"))
    for number in range(6):
        press(page, page.locator(f"#{'yes' if number % 2 == 0 else 'no'}-{number}"))
    go(page, button(page, "Hand in the answers"))


def test_each_card_leads_to_its_room(page, served):
    seen(page)
    for name in ("Describe an activity", "Choose a description", "Review programs", "Mark steps", "Grade programs"):
        go(page, link(page, name))
        seen(page)
        if link(page, "Back").count():
            go(page, link(page, "Back"))
        page.goto(f"{served.address}/annotate/")
    assert link(page, "Describe a film").count() == 0, "there are no films"
    go(page, link(page, "tutorial"))
    seen(page)
    go(page, link(page, "Choose a description"))
    assert go(page, link(page, "Describe the first one")) == "Describe an activity"


def test_a_program_is_described_written_run_and_handed_in(page, served):
    page.goto(f"{served.address}/annotate/describe")
    describe(page)
    go(page, link(page, "back"))
    page.goto(f"{served.address}/annotate/tasks")
    seen(page)
    go(page, page.locator(".list a").first)
    seen(page)
    for name in ("1. Task list", "2. Read", "3. Set the scene", "4. Write the program"):
        page.goto(f"{served.address}/annotate/tasks")
        go(page, page.locator(".list a").first)
        go(page, link(page, name))
    page.goto(f"{served.address}/annotate/tasks")
    go(page, page.locator(".list a").first)
    go(page, link(page, "Set the scene"))
    press(page, "summary")
    assert not page.locator("details p").is_visible()
    page.fill("#thing", "sofa")
    page.fill("#quantity", "2")
    go(page, button(page, "Add it"))
    page.fill("#prop-sofa", "1")
    seen(page)
    page.goto(f"{served.address}/annotate/tasks")
    to_composer(page)
    press(page, "summary")
    press(page, "#show-blocks")
    page.wait_for_selector(".blocklySvg")
    press(page, "#show-list")
    for action, thing in (*STEPS, ("Walk", "television")):
        add(page, action, thing)
    page.fill("#special", "eat some crisps")
    press(page, "#add-special button")
    saved(page)
    for number, sign in ((4, "↑"), (3, "↓"), (5, "×"), (4, "×")):
        press(page, page.locator(f"#steps li:nth-child({number}) button", has_text=sign))
    saved(page)
    assert page.locator("#steps .words").all_text_contents() == ["Walk to living room", "Walk to sofa", "Sit on sofa"]
    page.select_option("#home", "maple")
    press(page, "#run")
    page.wait_for_selector("#result .good")
    press(page, "#on")
    assert page.locator(".ticks li[aria-current]").count() == 1
    press(page, "#back")
    press(page, "#play")
    page.locator("#play", has_text="Pause").wait_for()
    press(page, "#in-3d")
    page.wait_for_selector("canvas.replay[data-ready]", timeout=120_000)
    seen(page)
    press(page, "#submit")
    page.wait_for_url("**/annotate/tasks*")
    go(page, page.locator(".list a").first)
    go(page, link(page, "Set the scene"))


def handed_in_again(page):
    """Hand a program in as it is, and open it as one that is handed in."""
    for control in ("#submit", "#sure"):
        press(page, control)
    page.wait_for_url("**/annotate/tasks*")
    go(page, page.locator(".list a").first)
    page.goto(f"{page.url}/compose")


def test_a_program_is_edited_handed_in_as_it_is_taken_back_and_deleted(page, served):
    page.goto(f"{served.address}/annotate/describe")
    describe(page)
    go(page, page.get_by_role("link", name="Write the program for"))
    page.go_back()
    go(page, link(page, "Your work"))
    page.goto(f"{served.address}/annotate/tasks")
    to_composer(page)
    add(page, "Walk", "sofa")
    for keep in ("#leave-step", "#keep-step"):
        press(page, page.locator("#steps button[aria-label^='Change step 1']"))
        page.select_option("#slot-0", label="television")
        press(page, keep)
    press(page, "#undo")
    press(page, "#redo")
    with page.context.expect_page() as opened:
        press(page, page.get_by_role("link", name="Help"))
    opened.value.close()
    page.select_option("#action", "Dance")
    press(page, "#add-step button")
    handed_in_again(page)
    go(page, page.locator("main").get_by_role("link", name="another description"))
    page.goto(f"{served.address}/annotate/")
    go(page, link(page, "Your work"))
    go(page, page.get_by_role("link", name="Look at it"))
    go(page, link(page, "Your work"))
    go(page, button(page, "Take it back, to change it"))
    page.wait_for_selector("#action option", state="attached")
    handed_in_again(page)
    go(page, button(page, "Take it back, to change it"))
    page.goto(f"{served.address}/mine")
    go(page, link(page, "Your work"))
    go(page, page.locator("main").get_by_role("link", name=TITLE, exact=True))
    for _ in range(2):
        page.goto(f"{served.address}/annotate/mine")
        press(page, page.locator("summary").first)
        go(page, button(page, "Delete it"))
    seen(page)


def test_a_program_is_reviewed_marked_and_graded(page, served):
    handed_in(page, served)
    author = page.context
    page.context.clear_cookies()
    page.goto(f"{served.address}/annotate/")
    press(page, page.get_by_role("button", name="Begin"))
    page.wait_for_selector("h1")
    reviewer(page, served)
    go(page, link(page, "Review programs"))
    seen(page)
    go(page, page.locator(".list a").first)
    seen(page)
    go(page, link(page, "All programs that wait"))
    go(page, page.locator(".list a").first)
    go(page, link(page, "Correct it"))
    page.wait_for_selector("#action option", state="attached")
    go(page, link(page, "Back to the review"))
    page.fill("#note", "Sit down on the sofa first.")
    go(page, button(page, "Return it with the note"))
    assert author is page.context


def test_the_steps_of_a_task_lead_to_one_another(page, served):
    page.goto(f"{served.address}/annotate/describe")
    describe(page)
    page.goto(f"{served.address}/annotate/tasks")
    to_composer(page)
    task = page.url.removesuffix("/compose")
    for start in ("compose", "scene"):
        for name in ("1. Task list", "2. Read", "3. Set the scene", "4. Write the program"):
            page.goto(f"{task}/{start}")
            go(page, link(page, name))


def test_the_desk_reads_and_erases_a_program(page, served):
    handed_in(page, served)
    assert "Thank you: your program is handed in" in page.inner_text("main")
    page.goto(f"{served.address}/annotate/describe")
    describe(page, "Have another look at the television", f"Once more: {TEXT}")  # the same words would be questioned
    page.goto(f"{served.address}/annotate/tasks?thanks=yes")
    go(page, page.get_by_role("link", name="Go on with"))
    page.goto(served.desk)
    page.goto(f"{served.address}/desk/annotate/")
    press(page, "summary")
    assert go(page, page.locator("tbody a").first) == TITLE
    seen(page)
    go(page, link(page, "Desk: Annotate"))
    go(page, page.locator("tbody a").first)
    go(page, button(page, "Erase this program"))
    assert "Nobody has handed in a program" in page.inner_text("main")


def test_an_accepted_program_is_marked_and_graded(page, served):
    handed_in(page, served)
    page.context.clear_cookies()
    page.goto(f"{served.address}/annotate/")
    press(page, page.get_by_role("button", name="Begin"))
    page.wait_for_selector("h1")
    reviewer(page, served)
    go(page, link(page, "Review programs"))
    go(page, page.locator(".list a").first)
    go(page, button(page, "Accept it as it is"))
    go(page, link(page, "Back"))
    page.goto(f"{served.address}/annotate/sketch")
    press(page, "#keep-2")
    seen(page)
    go(page, button(page, "Keep it and go on"))
    assert go(page, link(page, "Back")) == "Annotate"
    page.goto(f"{served.address}/annotate/rate")
    press(page, "#grade-1")
    seen(page)
    go(page, button(page, "Keep it and go on"))
    assert go(page, link(page, "Back")) == "Annotate"


def test_a_failed_test_is_tried_again(page, served):
    desk = page.context.browser.new_context().new_page()
    desk.goto(served.desk)
    desk.goto(f"{served.address}/desk/annotate/")
    desk.get_by_role("button", name="Invite a reviewer").click()
    page.goto(desk.input_value("#link"))
    desk.context.close()
    go(page, button(page, "Become a reviewer"))
    go(page, link(page, "Take the test"))
    for _ in range(3):
        for number in range(6):
            press(page, page.locator(f"#yes-{number}"))
        go(page, button(page, "Hand in the answers"))
        if not link(page, "Try again").count():
            break
        go(page, link(page, "tutorial"))
        page.go_back()
        go(page, link(page, "Try again"))
    go(page, link(page, "Annotate")) if link(page, "Annotate").count() else None


def test_the_session_and_the_frame_of_every_page(page, served):
    for name in ("Annotate", "Play", "Study", "Your session"):
        go(page, page.locator("header").get_by_role("link", name=name, exact=True))
    seen(page)
    address = page.input_value("#link")
    press(page, "#link")
    go(page, link(page, "What is stored, and how to erase it"))
    seen(page)
    go(page, link(page, "Your session"))
    page.locator("a.skip").focus()
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.id") == "main"
    assert go(page, page.locator("header .name")) == "What people do at home"
    seen(page)
    for name in ("Annotate", "Play", "Study"):
        page.goto(served.address)
        go(page, link(page, f"Go to {name}"))
    page.goto(served.address)
    go(page, link(page, "What is stored of you"))
    page.goto(address)
    assert "Open this session here?" in page.inner_text("h1")
    go(page, link(page, "Leave it as it is"))
    page.context.clear_cookies()
    page.goto(address)
    go(page, page.locator("main button"))
    page.goto(f"{served.address}/mine")
    press(page, "summary")
    assert go(page, button(page, "Delete my session and all my answers")) == "What people do at home"
    for name in ("Play", "Study", "Annotate"):
        page.context.clear_cookies()
        page.goto(served.address)
        go(page, button(page, f"Begin with {name}"))


def test_the_desk_of_each_room(page, served):
    handed_in(page, served)
    page.goto(f"{served.address}/annotate/tasks")
    text = page.locator(".list a").first.get_attribute("href").rpartition("/")[2]
    page.goto(f"{served.address}/study/")
    go(page, page.get_by_role("button", name="agree to take part"))
    page.goto(f"{served.address}/play/")
    go(page, page.locator("form[aria-labelledby=wah-title] button"))
    page.wait_for_selector("#game[data-tick]")
    press(page, "#finish")
    press(page, page.locator("#sure").get_by_role("button", name="Finish"))
    page.locator("#banner", has_text="You finished").wait_for()
    page.goto(served.address)
    go(page, link(page, "the desk"))
    page.fill("#token", served.desk.rpartition("/")[2])
    assert go(page, button(page, "Enter")) == "The researcher's desk"
    seen(page)
    for name in ("Annotate", "Play", "Study"):
        page.goto(f"{served.address}/desk")
        go(page, link(page, f"Open the desk of {name}"))
        seen(page)
    for name in ("Download the tables", "Download the report", "Download the list for payment"):
        with page.expect_download():
            press(page, link(page, name))
    press(page, "summary")
    page.goto(f"{served.address}/desk/play/")
    with page.expect_download():
        press(page, page.locator("tbody a").first)
    page.goto(f"{served.address}/desk/annotate/")
    for each in page.locator("main .list a").all():
        with page.expect_download():
            press(page, each)
    assert go(page, button(page, "Invite a reviewer")) == "Invite a reviewer"
    press(page, "#link")
    go(page, link(page, "Desk: Annotate"))
    go(page, link(page, "The desk"))
    page.goto(f"{served.address}/desk/annotate/")
    page.fill("#id", text)
    go(page, button(page, "Erase it"))
    page.goto(f"{served.address}/desk/study/")
    go(page, page.get_by_role("button", name="Give away"))
    go(page, page.get_by_role("button", name="Delete"))


def test_no_control_of_these_pages_is_without_a_test(records, width):
    """Also: no button of all these tests changed nothing, and nobody reads what is for developers."""
    tests = {name for name in globals() if name.startswith("test_")} - {
        "test_no_control_of_these_pages_is_without_a_test"
    }
    if missing := tests - records[width].ran:
        pytest.skip(f"not run, or failed: {', '.join(sorted(missing))}")
    others = ("/play/", "/study/")
    assert [each for each in records[width].unused() if not each.startswith(others)] == []
    assert sorted(records[width].dead) == []
    assert sorted(each for each in records[width].read if not each[0].startswith(others)) == []
