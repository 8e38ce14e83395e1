"""The choice among a program's sketches: people's, or those inferred from the steps that repairs can restore."""

from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

ANNOTATED, INFERRED = "annotated", "inferred"

_PEOPLE = "origin IN ('written', 'people', 'written_parent', 'people_parent')"

_KINDS = {ANNOTATED: _PEOPLE, INFERRED: f"NOT ({_PEOPLE})"}


def sketches_query(kind: str = ANNOTATED) -> str:
    """Return a query of `program_id` and `keep`: the sketch of each program; one of the kind goes before others.

    Raises:
        HearthError: BAD_ARGUMENT, for another kind.
    """
    if kind not in _KINDS:
        raise HearthError.of(
            Code.BAD_ARGUMENT, f"no sketches are `{kind}`", suggestion=f"there are {', '.join(_KINDS)}"
        )
    return f"""SELECT program_id, coalesce(min(keep) FILTER ({_KINDS[kind]}), min(keep)) AS keep
        FROM sketches WHERE keep IS NOT NULL GROUP BY 1"""
