"""The name under which the command line was called: help and hints show the same name to the reader."""

import re
import sys
from pathlib import Path
from typing import Any

INSTALLED = "hearth"
"""Name of the command, as docstrings and pages write it."""

OF_CHECKOUT = "python cli.py"
"""Name of the command for a reader who starts it from a checkout without installing it."""

CALL = re.compile(rf"^(?P<margin>\s*){INSTALLED}(?= )", re.MULTILINE)
"""A line of an example that calls the command."""


def program_name() -> str:
    """Return the name that the reader can type: the program `cli.py` in a checkout, `hearth` once installed."""
    return OF_CHECKOUT if Path(sys.argv[0]).name == "cli.py" else INSTALLED


def show_name(command: Any) -> None:
    """Let the help of a command, and of the commands of a group, show the name under which they were called."""
    command.help = CALL.sub(rf"\g<margin>{program_name()}", command.help or "")
    for each in getattr(command, "commands", {}).values():
        show_name(each)
