"""Pages at 320 pixels, magnified twice, light and dark, and their weight on the network."""

from __future__ import annotations

import pytest
from studies.small import SMALL
from web.people import accessibility
from web.used_controls import fits

pytestmark = pytest.mark.tools

PAGES = ("/", "/annotate/", "/annotate/tutorial", "/annotate/describe", "/annotate/tasks", "/play/", "/play/pair",
         "/play/game/", "/mine", "/privacy", "/study/")  # fmt: skip
"""Addresses of people's pages; the page of a game stands for all games."""

WINDOWS = {"320 pixels": (320, 640, 1.0), "magnified twice": (700, 450, 2.0)}
"""Width and height in pixels of the page, and pixels of the screen for each: 1400 magnified twice are 700."""

HEAVIEST = 600_000
"""Bytes of a page with all that it loads, compressed, 3D apart."""


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    from web.people import Serving

    folder = tmp_path_factory.mktemp("narrow")
    (folder / "study.yaml").write_text(SMALL)
    started = Serving(folder / "served", "--study", str(folder / "study.yaml"))
    yield started.address
    started.kill()


def opened(page, address, path):
    """Open a page as a person with a session; of a game, after it has begun."""
    page.set_default_timeout(120_000)
    page.goto(f"{address}/play/")
    if page.locator('form[action="/begin"]').count():
        page.locator('form[action="/begin"] button').first.click()
        page.wait_for_url("**/play/")
    if path != "/play/game/":
        page.goto(address + path)
        return
    page.locator("form[aria-labelledby=wah-title] button").click()
    page.wait_for_selector("#game[data-tick]")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("window", WINDOWS)
def test_nothing_is_lost_in_a_small_window(browser, address, window, scheme):
    width, height, scale = WINDOWS[window]
    context = browser.new_context(
        viewport={"width": width, "height": height}, device_scale_factor=scale, color_scheme=scheme
    )
    page, lost = context.new_page(), []
    for path in PAGES:
        opened(page, address, path)
        if not fits(page):
            lost.append(f"{path} is {page.evaluate('document.documentElement.scrollWidth')} wide")
        lost += [f"{path}: {each}" for each in accessibility(page)]
    context.close()
    assert lost == []


@pytest.mark.parametrize("path", PAGES)
def test_a_page_weighs_little(browser, address, path):
    context = browser.new_context()
    page = context.new_page()
    network, got = context.new_cdp_session(page), []
    network.send("Network.enable")
    network.on("Network.loadingFinished", lambda each: got.append(each["encodedDataLength"]))
    opened(page, address, path)
    page.wait_for_load_state("networkidle")
    context.close()
    assert 1_000 < sum(got) < HEAVIEST, f"{path}: {sum(got):,} bytes"
