"""The record of controls finds each fault that it is for: an unused control, a dead button, an error, a code."""

from __future__ import annotations

import pytest
from web.used_controls import NARROW, WIDE, Record, press

pytestmark = pytest.mark.tools

PAGE = """<!doctype html><title>Test</title><main><h1>Test</h1><p>BAD_ARGUMENT at kids_bedroom</p>
<button id="good" onclick="this.textContent += '!'">Good</button> <button id="dead">Dead</button>
<button id="hidden" hidden>Hidden</button> <button id="off" disabled>Off</button>
<select id="choice"><option>one</option><option>two</option></select> <a href="/game/a1b2">A game</a></main>"""


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_every_kind_of_fault_is_found(browser, width):
    record = Record()
    with record.pages(browser, width) as context:
        context.route("**/*", lambda route: route.fulfill(body=PAGE, content_type="text/html"))
        page = context.new_page()
        page.goto("http://127.0.0.1:9/play/")
        for name in ("#good", "#dead"):
            press(page, name)
        page.select_option("#choice", "two")
        page.wait_for_timeout(4_500)
    assert record.unused() == ["/play/ a /game/*"], "a hidden or disabled button is not counted"
    assert record.dead == {("/play/", "button dead")}
    assert {word for _, word in record.read} == {"BAD_ARGUMENT", "kids_bedroom"}


def test_a_refused_request_fails(browser):
    with pytest.raises(AssertionError, match=": 500"), Record().pages(browser, WIDE) as context:
        context.route("**/*", lambda route: route.fulfill(body=PAGE, status=500, content_type="text/html"))
        context.new_page().goto("http://127.0.0.1:9/play/")
