"""Open and closed, on and off, plugged and unplugged: what is so already is left out, what is needed is done first."""

from hearth.repair.handlers.common import Edit, RepairContext, before, removed
from hearth.repair.handlers.locomotion import walked_to


def is_closed(context: RepairContext) -> Edit | None:
    """Leave the Close out; before putting something into it, open it."""
    action = context.step.action
    if action == "Close":
        return removed(context, "already_closed")
    name = "closed_to_put_back" if action == "PutObjBack" else "closed_to_put_in"
    return before(context, name, context.does("Open", context.object()))


def inside_closed(context: RepairContext) -> Edit | None:
    """Open the container first, having walked to it if it is not close."""
    container = context.object(1)
    opened = context.does("Open", container)
    if context.is_close(context.index(1)):
        return before(context, "inside_closed", opened)
    return walked_to(context, "inside_closed", container, opened)


def is_on(context: RepairContext) -> Edit | None:
    """Leave the SwitchOn out; before opening what runs, switch it off."""
    if context.step.action == "SwitchOn":
        return removed(context, "already_on")
    return before(context, "on_to_open", context.does("SwitchOff", context.object()))


def is_off(context: RepairContext) -> Edit | None:
    """Leave the SwitchOff out; before watching it, switch it on."""
    if context.step.action == "SwitchOff":
        return removed(context, "already_off")
    return before(context, "off_to_watch", context.does("SwitchOn", context.object()))


def is_unplugged(context: RepairContext) -> Edit | None:
    """Leave the PlugOut out; before switching it on, plug it in."""
    if context.step.action == "PlugOut":
        return removed(context, "already_unplugged")
    if not context.world.home.able("PlugIn") >> context.index() & 1:
        return None
    return before(context, "unplugged_to_switch_on", context.does("PlugIn", context.object()))
