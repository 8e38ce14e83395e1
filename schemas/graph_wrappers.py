"""Values that hold a scene graph: a pair of a release, a log or an answer of a simulator."""

from typing import Any

WRAPPERS = ("init_graph", "graph", "final_graph")
"""Keys under which files hold a graph; the first of them that a file has is read."""


def graph_in(value: Any, which: str = "") -> dict[str, Any] | None:
    """Return the graph that a JSON value is or holds, or None.

    Args:
        value: of a file.
        which: the key to prefer.
    """
    if isinstance(value, list) and len(value) == 2 and value[0] is True:
        value = value[1]  # a simulator's answer: whether it succeeded, and the graph
    if not isinstance(value, dict):
        return None
    for key in (which, *WRAPPERS):
        inner = value.get(key)
        if isinstance(inner, dict) and {"nodes", "edges"} <= inner.keys():
            return inner
    return value if {"nodes", "edges"} <= value.keys() else None
