"""The name under which the command line was called: help and hints show what the same reader can type."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

OF_CHECKOUT = "python cli.py"
"""As the docstrings of commands write it."""


def program_name() -> str:
    """`python cli.py` in a checkout, `hearth` once installed."""
    return OF_CHECKOUT if Path(sys.argv[0]).name == "cli.py" else "hearth"


def show_name(command: Any) -> None:
    """Let the help of a command, and of the commands of a group, show the name under which they were called."""
    command.help = (command.help or "").replace(OF_CHECKOUT, program_name())
    for each in getattr(command, "commands", {}).values():
        show_name(each)
