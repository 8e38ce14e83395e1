"""Help that is plain: names of arguments as people write them, and the first sentence of each command, whole."""

import re
from typing import Any


def make_plain(command: Any) -> None:
    """Let the help of a command, and of the commands of a group, show plain names and whole sentences."""
    for parameter in command.params:
        if parameter.param_type_name == "argument":
            parameter.get_usage_pieces = lambda ctx, its=parameter: [_usage(its)]
            parameter.display_type_rich = lambda ctx: ""  # `list[Path]` is a word of Python
    for each in getattr(command, "commands", {}).values():
        # Of the help alone, as many words are shown as fit into a line.
        each.short_help = _first_sentence(each.help or "")
        make_plain(each)


def _usage(argument: Any) -> str:
    """Return `FILE`, `FILE...`, `[FILE]` or `[FILE]...`."""
    name: str = argument.metavar or argument.name.upper()
    shown = name if argument.required else f"[{name}]"
    return shown if argument.nargs == 1 else f"{shown}..."


def _first_sentence(text: str) -> str:
    paragraph = " ".join(text.strip().partition("\n\n")[0].split())
    return re.split(r"(?<=\.)\s", paragraph, maxsplit=1)[0]
