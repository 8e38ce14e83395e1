"""Time limits of commands where `--within` is not given, in seconds; `--within 0` sets none."""

WITHIN: float = 3600
"""Time for `verify`, `diff`, `export`, `report` and `kb mine`, which may be given a stranger's dataset."""

QUERY_WITHIN: float = 60
"""Time for `query`, whose question may be a stranger's, too."""

ANSWER_WITHIN: float = 30.0
"""Time for an answer of an agent in `play`, for each tick; `challenge run` gives as much (`agent_guard.SECONDS`)."""
