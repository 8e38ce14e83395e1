"""Pages and cards of ours, made from templates in the folders of their modules."""

from collections.abc import Callable, Mapping
from importlib.resources import files
from typing import Any


def rendered(package: str, file: str, filters: Mapping[str, Callable[..., Any]] | None = None, **values: Any) -> str:
    """Return a template of a package with these values; in HTML every text is escaped.

    Args:
        package: with the template.
        file: its name, or its path in the package.
        filters: functions that the template calls, by name.
        values: what it shows.
    """
    import jinja2

    made = jinja2.Environment(autoescape=file.endswith(".html"), trim_blocks=True, lstrip_blocks=True)
    made.filters.update(filters or {})
    return made.from_string((files(package) / file).read_text("utf-8")).render(values)
