"""The first paint of people's pages over a slow network, and the bytes of each with all that it loads.

    python benchmarks/first_paint.py [--kbits 400] [--latency 400]

A Chromium opens each page without anything kept, over a network with that many kilobits a second and that many
milliseconds to an answer (the usual figures of slow 3G). Printed are the seconds until something was painted, until
the page was loaded, and the kilobytes.
"""

from __future__ import annotations

import argparse
import shutil
import tempfile
from pathlib import Path

from play_sessions import serve
from playwright.sync_api import Browser, sync_playwright

PAGES = ("/", "/annotate/", "/annotate/tutorial", "/annotate/describe", "/play/", "/play/pair", "/play/game/", "/mine")

PAINT = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? -1"


def paint(browser: Browser, address: str, path: str, kbits: float, latency: float) -> tuple[float, float, float]:
    """Seconds until the first paint and until all is loaded, and the kilobytes."""
    context = browser.new_context()
    page = context.new_page()
    page.set_default_timeout(120_000)
    page.goto(f"{address}/play/")
    page.locator('form[action="/begin"] button').first.click()
    page.wait_for_url("**/play/")
    if path == "/play/game/":
        page.locator("form[aria-labelledby=wah-title] button").click()
        page.wait_for_selector("#game[data-tick]")
        path = page.url.removeprefix(address)
    page.goto("about:blank")
    network, got = context.new_cdp_session(page), []
    network.send("Network.enable")
    network.send("Network.setCacheDisabled", {"cacheDisabled": True})
    rate = kbits * 1000 / 8
    limits = {"offline": False, "latency": latency, "downloadThroughput": rate, "uploadThroughput": rate}
    network.send("Network.emulateNetworkConditions", limits)
    network.on("Network.loadingFinished", lambda each: got.append(each["encodedDataLength"]))
    page.goto(address + path, wait_until="load")
    while (painted := page.evaluate(PAINT) / 1000) < 0:  # `wait_for_function` is refused by the policy
        page.wait_for_timeout(100)
    loaded = page.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd") / 1000
    context.close()
    return painted, loaded, sum(got) / 1000


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kbits", type=float, default=400)
    parser.add_argument("--latency", type=float, default=400)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        process, address = serve(Path(folder))
        path = shutil.which("chromium") or "chromium"
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox"])
        try:
            for each in PAGES:
                painted, loaded, weight = paint(browser, address, each, asked.kbits, asked.latency)
                print(f"{each:20} first paint {painted:5.2f} s   loaded {loaded:5.2f} s   {weight:6.1f} kB")
        finally:
            browser.close()
            process.kill()


if __name__ == "__main__":
    main()
