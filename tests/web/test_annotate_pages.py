"""Pages of Annotate and of the other rooms in a browser: a film is described, every page is accessible and fits."""

from __future__ import annotations

import subprocess
import sys

import pytest
from web.people import AXE, ROOT, accessibility, watched
from web.test_annotate_browser import FORM, TEXT, TITLE, describe, opened, set_scene  # noqa: F401


@pytest.fixture(scope="module")
def filmed(tmp_path_factory):
    """A dataset with a film, built by the command."""
    folder = tmp_path_factory.mktemp("filmed")
    source = ROOT / "tests/golden/pipelines/input/programs/evening.txt"
    options = ["--home", "maple", "--variants", "0", "--pictures", "1", "--videos", "1", "-j", "1"]
    subprocess.run([sys.executable, str(ROOT / "cli.py"), "build", str(source), *options, "--out", str(folder)],
                   check=True, capture_output=True, cwd=ROOT)  # fmt: skip
    return folder


def until(page, wanted) -> None:
    """Wait until an expression holds; the policy of the pages does not let Playwright wait for one."""
    for _ in range(600):
        if page.evaluate(wanted):
            return
        page.wait_for_timeout(100)
    raise AssertionError(wanted)


def test_a_film_is_described(browser, serving, filmed):
    """A real film of a dataset: seen, described in words, and in the file that sets the words beside the program."""
    server, faults = serving("--films", str(filmed)), []
    page = watched(browser.new_context(viewport=FORM).new_page(), faults)
    page.goto(f"{server.address}/annotate/")
    page.goto(server.address)
    page.click("text=Begin with Annotate")
    page.goto(f"{server.address}/annotate/film")
    until(page, "document.querySelector('video').readyState > 1")
    assert page.evaluate("document.querySelector('video').videoWidth") == 320
    page.evaluate("document.querySelector('video').play()")
    until(page, "document.querySelector('video').currentTime > 0.3")
    assert accessibility(page) == []
    page.fill("#title", "x")
    page.fill("#description", "Somebody.")
    page.click("text=Keep it and go on")
    assert page.locator(".note p").count() > 0, "what lacks is asked for politely"
    page.fill("#title", TITLE)
    page.fill("#description", TEXT)
    page.click("text=Keep it and go on")
    assert "No film is left" in page.text_content("main")
    assert page.context.request.get(f"{server.address}/annotate/film-of/other").status == 404
    kept = "".join(path.read_text() for path in server.out.glob("films*"))
    assert TITLE in kept and "[Walk]" in kept
    assert [fault for fault in faults if "401" not in fault and "400" not in fault] == []


OTHER_PAGES = ("/", "/mine", "/play/", "/play/join/x", "/study/", "/desk/enter", "/nowhere")


DESKS = ("/desk", "/desk/annotate/", "/desk/play", "/desk/study/")


@pytest.mark.parametrize(("scheme", "width"), [("light", 1400), ("dark", 360)])
def test_pages_of_the_other_rooms_are_accessible_and_fit(browser, serving, scheme, width):
    server = serving("--study", "people-alone")
    page = browser.new_context(viewport={"width": width, "height": 800}, color_scheme=scheme).new_page()
    page.goto(server.address)
    page.click("text=Begin with Annotate")
    page.context.request.post(f"{server.address}/study/agree", form={"agree": "yes"})
    found = {}
    for path in (*OTHER_PAGES, "desk", *DESKS):
        page.goto(server.desk if path == "desk" else server.address + path)
        found[path] = accessibility(page)
        if page.evaluate("document.documentElement.scrollWidth") > width:
            found[path].append("wider than the window")
    assert {path: each for path, each in found.items() if each} == {}


PAGES = ("/", "/mine", "/desk/enter", *(f"/annotate/{name}" for name in (
    "", "tutorial", "describe", "tasks", "test", "review", "sketch", "rate", "film")))  # fmt: skip


@pytest.mark.skipif(not AXE.is_file(), reason="no axe-core: make web")
@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1400, 360])
def test_pages_are_accessible_and_fit(opened, scheme, width):  # noqa: F811
    page = opened(color_scheme=scheme)
    page.set_viewport_size({"width": width, "height": 800})
    page.click("text=Begin with Annotate")
    describe(page)
    page.goto(f"{opened.server.address}/annotate/tasks")
    address = page.locator(".list a").get_attribute("href")
    set_scene(page)
    page.wait_for_selector("#action option", state="attached")
    found = {}
    for path in (None, *PAGES, address, f"{address}/scene"):
        if path:
            page.goto(opened.server.address + path)
        found[path] = [*accessibility(page)]
        if page.evaluate("document.documentElement.scrollWidth") > width:
            found[path].append("wider than the window")
    page.goto(opened.server.desk)
    page.goto(f"{opened.server.address}/desk/annotate/")
    found["desk"] = accessibility(page)
    assert {path: each for path, each in found.items() if each} == {}
