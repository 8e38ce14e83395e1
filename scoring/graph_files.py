"""Final graphs from files, and the nodes that programs name from the command line."""

from pathlib import Path

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.graph import EnvironmentGraph, from_release
from hearth.storage.inputs import read_input

FINAL = "final_graph"


def final_graph(path: Path) -> EnvironmentGraph:
    """Read a scene graph, or the final graph of a pair as the release stores it.

    Raises:
        HearthError: MISSING_FILE, BAD_JSON or BAD_GRAPH.
    """
    import orjson

    content = read_input(path)
    try:
        data = orjson.loads(content)
    except orjson.JSONDecodeError as error:
        raise HearthError.of(Code.BAD_JSON, f"not JSON: {error}", file=str(path)) from None
    if isinstance(data, dict) and FINAL in data:
        data = data[FINAL]
    if not isinstance(data, dict):
        raise HearthError.of(Code.BAD_GRAPH, "not an environment graph", file=str(path), suggestion="nodes and edges")
    return from_release(data, str(path))


def node_ids(text: str) -> tuple[list[int], list[int]]:
    """`41,65` for both programs, or `41,65/41`: the prediction's, then the reference's.

    Raises:
        HearthError: SYNTAX, if an id is not a number.
    """
    ours, _, theirs = text.partition("/")
    try:
        found = [[int(word) for word in part.split(",") if word.strip()] for part in (ours, theirs or ours)]
    except ValueError as error:
        raise HearthError.of(Code.SYNTAX, f"--nodes: {error}", suggestion="ids such as 41,65 or 41,65/41") from None
    return found[0], found[1]
