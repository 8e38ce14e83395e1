"""The parts that Inspect AI finds by the entry point of the package."""

from hearth_inspect.household import acting, household, reached

__all__ = ["acting", "household", "reached"]
