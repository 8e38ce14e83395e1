"""Reading our YAML, and how much that of others may hold: a short alias may stand for a million values."""

from importlib.resources import files
from typing import Any

import yaml

LARGEST = 4 << 20
"""Characters of a file of somebody else's, at most; ours are smaller by far."""
MOST = 100_000
"""Values in one, aliases written out."""
DEEPEST = 20
"""Values that stand in one another."""

LIMITS = f"at most {LARGEST:,} bytes, {MOST:,} values, {DEEPEST} in one another"

LOADER: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def packaged(package: str, file: str) -> Any:
    """Return the content of a YAML file of ours, which lies in a package."""
    return yaml.load((files(package) / file).read_text("utf-8"), LOADER)


def too_much(text: str) -> str:
    """Return why a text is not read as YAML; "" where it may be. A fault of form is left for the reader to name.

    It takes time in proportion to the text, whatever its aliases stand for.
    """
    if len(text) > LARGEST:
        return f"{len(text):,} characters are too many"
    return "" if _is_small(text) else "it holds too many values, or itself"


def _is_small(text: str) -> bool:
    known: dict[str | None, int] = {}
    open_values: list[tuple[str | None, int]] = [(None, 0)]
    try:
        for event in yaml.parse(text, LOADER):
            anchor = getattr(event, "anchor", None)
            if isinstance(event, yaml.CollectionStartEvent):
                known.pop(anchor, None)
                open_values.append((anchor, 1))
                if len(open_values) > DEEPEST:
                    return False
                continue
            number = 0
            if isinstance(event, yaml.AliasEvent):
                number = known.get(anchor, MOST)
            elif isinstance(event, yaml.ScalarEvent):
                number = known[anchor] = 1
            elif isinstance(event, yaml.CollectionEndEvent):
                anchor, number = open_values.pop()
                known[anchor] = number
            outer, before = open_values[-1]
            open_values[-1] = (outer, before + number)
            if before + number > MOST:
                return False
    except yaml.YAMLError:
        pass
    return True
