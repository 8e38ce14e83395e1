"""A link to come back, in a real browser: it asks, and its token leaves the address bar and the history."""

from __future__ import annotations

import pytest
from web.people import watched

pytestmark = pytest.mark.tools


def test_a_link_asks_and_its_token_leaves_the_address(serving, browser):
    address, faults = serving().address, []
    first, second = (watched(browser.new_context().new_page(), faults) for _ in range(2))
    for page in (first, second):
        page.goto(address)
        page.click("text=Begin with Annotate")
    first.goto(f"{address}/mine")
    link, mine = first.input_value("#link"), first.inner_text("main strong")
    second.goto(f"{address}/mine")
    other = second.inner_text("main strong")
    second.goto(link)
    assert second.url == f"{address}/come" and link.rpartition("/")[2] not in second.content()
    assert mine in second.inner_text("main") and other in second.inner_text("[role=alert]")
    second.click("text=Leave it as it is")
    second.goto(f"{address}/mine")
    assert second.inner_text("main strong") == other
    second.goto(link)
    second.click(f"text=Open the session {mine}")
    second.goto(f"{address}/mine")
    assert second.inner_text("main strong") == mine
    second.go_back()
    assert link.rpartition("/")[2] not in second.url
    assert not faults


def test_the_page_on_privacy_is_reached_from_the_start(serving, browser):
    page = browser.new_context(viewport={"width": 360, "height": 800}).new_page()
    page.goto(serving().address)
    page.click("text=What is stored of you")
    assert page.url.endswith("/privacy") and "How to erase it" in page.inner_text("main")
    assert page.evaluate("document.documentElement.scrollWidth") <= 360
