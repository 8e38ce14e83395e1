"""The option `--nodes`: the node ids that the objects of a prediction and its reference stand for."""

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


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
