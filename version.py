"""The version of the code and of what it publishes."""

from __future__ import annotations

VERSION = "0.2.0"

RELEASED = "2026-11-21"
"""The day of this version: what it publishes says so, and not when it was built, so that its bytes stay the same."""

ACTION_SET = "hearth-actions/1"
"""Names the meaning of the actions; it changes whenever a program could run differently."""
