"""Open and closed, on and off, plugged and unplugged: what is so already is left out, what is needed is done first."""

from __future__ import annotations

from hearth.repair.handlers.common import Edit, Trouble, before, removed
from hearth.repair.handlers.locomotion import gone_to


def is_open(trouble: Trouble) -> Edit | None:
    """Leave the Open out."""
    return removed(trouble, "already_open")


def is_closed(trouble: Trouble) -> Edit | None:
    """Leave the Close out; before putting something into it, open it."""
    action = trouble.step.action
    if action == "Close":
        return removed(trouble, "already_closed")
    name = "closed_to_put_back" if action == "PutObjBack" else "closed_to_put_in"
    return before(trouble, name, trouble.does("Open", trouble.object()))


def neither(trouble: Trouble) -> Edit | None:
    """Leave out opening or closing what is neither open nor closed."""
    return removed(trouble, "neither_open_nor_closed")


def inside_closed(trouble: Trouble) -> Edit | None:
    """Open the container first, having walked to it if it is not close."""
    container = trouble.object(1)
    opened = trouble.does("Open", container)
    if trouble.is_close(trouble.index(1)):
        return before(trouble, "inside_closed", opened)
    return gone_to(trouble, "inside_closed", container, opened)


def is_on(trouble: Trouble) -> Edit | None:
    """Leave the SwitchOn out; before opening what runs, switch it off."""
    if trouble.step.action == "SwitchOn":
        return removed(trouble, "already_on")
    return before(trouble, "on_to_open", trouble.does("SwitchOff", trouble.object()))


def is_off(trouble: Trouble) -> Edit | None:
    """Leave the SwitchOff out; before watching it, switch it on."""
    if trouble.step.action == "SwitchOff":
        return removed(trouble, "already_off")
    return before(trouble, "off_to_watch", trouble.does("SwitchOn", trouble.object()))


def is_plugged(trouble: Trouble) -> Edit | None:
    """Leave the PlugIn out."""
    return removed(trouble, "already_plugged")


def is_unplugged(trouble: Trouble) -> Edit | None:
    """Leave the PlugOut out; before switching it on, plug it in."""
    if trouble.step.action == "PlugOut":
        return removed(trouble, "already_unplugged")
    if not trouble.world.home.able("PlugIn") >> trouble.index() & 1:
        return None
    return before(trouble, "unplugged_to_switch_on", trouble.does("PlugIn", trouble.object()))
