"""A record of the controls that pages show and of those that tests use: a control that no test uses is a fault.

`used_controls.js` runs in every page and reports both. Pages of games, tasks and people count as one page each, and so
do buttons of one kind, such as those of things.
"""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from web.people import accessibility

SCRIPT = Path(__file__).with_name("used_controls.js")
WIDE, NARROW = 1400, 390
"""Widths of the pages that are tested, in pixels; the narrow one is touched, not clicked."""

Control = tuple[str, str]
"""A page's address, with `*` for ids, and a control of it."""


@dataclass
class Record:
    """The controls of the pages that tests opened.

    Attributes:
        seen: every control that a page showed, enabled.
        used: those that were clicked, touched, typed into or chosen from.
        dead: the buttons that changed nothing.
        read: words of people's pages that are for developers: codes, names of classes and fields, steps in brackets.
        faults: errors that a page did not catch, refused requests, and what consoles said of errors.
        ran: the names of the tests that recorded.
    """

    seen: set[Control] = field(default_factory=set)
    used: set[Control] = field(default_factory=set)
    dead: set[Control] = field(default_factory=set)
    read: set[Control] = field(default_factory=set)
    faults: list[str] = field(default_factory=list)
    ran: set[str] = field(default_factory=set)

    def unused(self) -> list[str]:
        """Return the controls that no test used."""
        return sorted(" ".join(each) for each in self.seen - self.used)

    @contextmanager
    def pages(self, browser, width: int, refused: tuple[str, ...] = (), **options):
        """Open a context whose pages are recorded, and check at its end that no page had a fault.

        Args:
            browser: that opens it.
            width: of its pages; at `NARROW` they are touched.
            refused: endings of the addresses that the test wants to be refused.
            options: of the context.
        """
        touched = {"has_touch": True, "is_mobile": True} if width == NARROW else {}
        context = browser.new_context(viewport={"width": width, "height": 900}, **touched, **options)
        for name, found in (("Saw", self.seen), ("Used", self.used), ("Dead", self.dead), ("Read", self.read)):
            context.expose_binding(f"hearth{name}", lambda _, page, control, found=found: found.add((page, control)))
        context.add_init_script(path=SCRIPT)
        faults: list[str] = []
        context.on("weberror", lambda found: faults.append(f"{found.page.url}: {found.error}"))
        context.on("response", lambda answer: _check(answer, faults, refused))
        context.on("requestfailed", lambda request: _failed(request, faults))
        yield context
        for page in context.pages:
            page.wait_for_timeout(300)
        self.faults += faults
        context.close()
        assert not faults, "\n".join(faults)


def _check(answer, faults: list[str], refused: tuple[str, ...]) -> None:
    if answer.status >= 400 and not answer.url.partition("?")[0].endswith(refused or ("\0",)):
        faults.append(f"{answer.url}: {answer.status}")


def _failed(request, faults: list[str]) -> None:
    if request.failure != "net::ERR_ABORTED":  # a page that was left, or a file that was kept
        faults.append(f"{request.url}: {request.failure}")


def press(page, target) -> None:
    """Press a control: with a finger where the page is a telephone's, else with the mouse."""
    found = page.locator(target) if isinstance(target, str) else target
    if page.viewport_size["width"] == NARROW:
        found.first.tap()
    else:
        found.first.click()


SIDES = ("width", "height")

_FREE = """shape => {
    const {x, y, width, height} = shape.getBoundingClientRect();
    for (let i = 1; i < 20; i++) for (let j = 1; j < 20; j++) {
        const at = [x + width * i / 20, y + height * j / 20];
        if (document.elementFromPoint(...at) === shape) return at;
    }
    return null;
}"""


def press_shape(page, selector: str) -> None:
    """Press the first shape of a drawing that is not wholly covered by others, where it is not.

    A finger misses what is a few pixels wide, such as a door: it is clicked, and a telephone has it as a button.
    """
    for shape in page.locator(selector).all():
        shape.scroll_into_view_if_needed()
        if at := shape.evaluate(_FREE):
            fingers = page.viewport_size["width"] == NARROW and min(shape.bounding_box()[side] for side in SIDES) > 8
            page.touchscreen.tap(*at) if fingers else page.mouse.click(*at)
            return
    raise AssertionError(f"every {selector} is covered")


def go(page, target) -> str:
    """Press a control that leads to another page, and return that page's heading."""
    with page.expect_navigation():
        press(page, target)
    return page.locator("h1").first.inner_text()


def fits(page) -> bool:
    """Return whether nothing of a page is wider than the window."""
    return page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def button(page, name):
    """Return the first button of the page's own part by its name."""
    return page.locator("main").get_by_role("button", name=name, exact=True).first


def link(page, name):
    """Return the first link of the page's own part by its name."""
    return page.locator("main").get_by_role("link", name=name, exact=True).first


def seen(page):
    """Assert that a page fits its width, and that axe finds nothing."""
    assert fits(page) and accessibility(page) == []
