"""Every control of a report's pages is used in a browser, at two widths, and axe finds nothing grave."""

from __future__ import annotations

import pytest
from web.people import accessibility
from web.used_controls import NARROW, WIDE, Record, press

import hearth
from hearth.datasets.report.report_writer import write_report

pytestmark = [pytest.mark.slow, pytest.mark.tools]


@pytest.fixture(scope="module")
def replayed(made, tmp_path_factory):
    """A report in which three runs play in 3D."""
    folder = tmp_path_factory.mktemp("replayed") / "out"
    write_report(hearth.load(made.out), folder, replays=3)
    return folder


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_every_control_of_a_report_is_used(replayed, browser, width):
    record = Record()
    with record.pages(browser, width) as context:
        page = context.new_page()
        page.goto((replayed / "index.html").as_uri())
        page.wait_for_selector(".row")
        assert accessibility(page) == []
        columns = page.locator("button[data-column]:visible")
        for number in range(columns.count()):
            press(page, columns.nth(number))
        page.fill("#search", "nothing is called like that")
        assert page.text_content("#found").startswith("0 of ")
        page.fill("#search", "")
        if page.locator("#pictured").is_enabled():
            press(page, "#pictured")
            press(page, "#pictured")
        for name in ("Numbers", "Homes", "Programs", "Hearth"):
            press(page, page.locator("header").get_by_role("link", name=name, exact=True))
        if page.locator("#strip a").count():
            press(page, page.locator("#strip a"))
            page.wait_for_selector("ol.steps li")
            page.go_back()
        press(page, page.locator(".row"))
        page.wait_for_selector("button.play")
        assert accessibility(page) == []
        for target in ("button.play", "text=›", "text=‹"):
            press(page, target)
        page.locator("select").select_option(index=0)
        page.goto(f"{(replayed / 'index.html').as_uri()}#/numbers")
        press(page, "summary")
        assert accessibility(page) == []
    assert [each for each in record.unused() if "button In" not in each] == []  # 3D: `test_a_browser_plays_a_run_in_3d`
    assert sorted(record.dead) == []
