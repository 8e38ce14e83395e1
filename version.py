"""Versions of the code and of the action sets; that of the format of datasets is `FORMAT` of `storage/manifest.py`."""

VERSION = "0.2.0"

DISTRIBUTION = "hearth-home-programs"
"""The name on the Python index, where `hearth` is another package."""

RELEASED = "2026-11-21"
"""The date of this version, stored in its datasets instead of the date of the build, so that bytes do not change."""

ACTION_SET = "hearth-actions/2"
"""Identifies the meaning of the actions; it changes whenever a program could run differently.

1: version 0.1. 2: `Walktowards`, `Walkforward`, `Turnleft` and `Turnright` are simulated, step modifiers have effects,
and nothing is put on or into itself.
"""

NEXT_ACTION_SET = "hearth-actions/3"
"""Every action is executed and has consequences, some in time (rule `consequences`); new datasets use it."""
