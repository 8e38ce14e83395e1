"""Household tasks in text for Inspect AI: `inspect eval hearth_inspect/household`."""

from hearth_inspect.inspect_task import acting, household, reached

__all__ = ["acting", "household", "reached"]
