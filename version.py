"""The version of the code and of what it publishes."""

from __future__ import annotations

VERSION = "0.1.0"

ACTION_SET = "hearth-actions/1"
"""Names the meaning of the actions; it changes whenever a program could run differently."""
