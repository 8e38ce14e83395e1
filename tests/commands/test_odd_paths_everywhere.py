"""Every command takes every path: each parameter that is a path, of the command line itself, is given odd names."""

from __future__ import annotations

import inspect
import sys
import typing
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from hearth import cli
from hearth.schemas.terminal import BIDIRECTIONAL

NAMES = (
    "q[1]", "a*b?", "[]]", "two words", "möbel ü", "new\nline", 'it\'s, "so"', "{a}%s", "%41;x", "-x", "~$HOME",
    "\u202egnp\x9b31m",
)  # fmt: skip

APART = {
    "serve": "it serves until it is stopped; `tests/web` start it with folders of their own",
    "build": "it takes long; `test_odd_paths.py` builds with odd names",
}
"""Commands that are not run here, with the reason."""

LONG = ("corpus", "sample", "ingest", "challenge watch", "render-", "home stats")
"""Beginnings of commands that are run with the slow tests alone."""

NEEDED = {
    "query": ("SELECT 1",), "export": ("--format", "jsonl"), "model table": ("1",),
    "model train": ("random-retrieval",), "challenge people": ("x",), "study simulate": ("x",), "study prepare": ("x",),
    "study figure": ("x",), "study forget": ("x",),
    "llm probe": ("x",), "llm judge": ("x", "x"), "model retrieval": ("--embed", "x"), "model predict": ("x",),
    "model figure": ("1", "--model", "x"), "model show": ("x",), "kb show": ("mug",),
    "kb action": ("Walk",), "kb find": ("mug",), "kb path": ("mug", "cup"), "kb export": ("pddl",),
    "home show": ("cabin",), "home lint": ("cabin",), "home convert": ("cabin",), "home export": ("cabin",),
    "home edit": ("cabin",), "home ways": ("cabin", "x", "y"), "challenge learn": ("x",), "render-visible": ("cabin",),
    "challenge show": ("x",), "challenge film": ("x",), "challenge export": ("lerobot",), "corpus synthesize": ("1",),
    "score graphs": ("--nodes", "1"), "challenge tasks": ("x",), "challenge build": ("x",), "challenge table": ("1",),
}  # fmt: skip
"""Words that a command needs besides its paths."""

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="these are no names on Windows")

PROGRAM = "Fetch milk\nGo to the fridge and open it.\n\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n"


def commands(group, before=()):
    """Every command of the command line, by its words."""
    if not hasattr(group, "list_commands"):
        yield " ".join(before), group
        return
    for name in group.list_commands(None):
        yield from commands(group.get_command(None, name), (*before, name))


def is_path(kind):
    return kind is Path or any(map(is_path, typing.get_args(kind)))


def paths(command):
    """The parameters of a command that are paths: name and whether each is an argument."""
    found = inspect.signature(command.callback, eval_str=True).parameters.values()
    return [each.name for each in found if is_path(each.annotation)]


COMMANDS = {name: command for name, command in commands(typer.main.get_command(cli.app)) if paths(command)}

CASES = [(name, parameter) for name, command in COMMANDS.items() if name not in APART for parameter in paths(command)]

FIRST = [(name, paths(command)[0]) for name, command in COMMANDS.items() if not name.startswith((*LONG, *APART))]


def words(name, parameter, odd, plain):
    """A command line in which one parameter has the odd path, and all that are required have one."""
    said = name.split()
    needed = [*NEEDED.get(name, ())]
    for each in COMMANDS[name].params:
        is_argument = type(each).__name__.endswith("Argument")
        if each.name == parameter:
            said += [str(odd)] if is_argument else [each.opts[0], str(odd)]
        elif each.name in paths(COMMANDS[name]) and each.required:
            said += [str(plain)] if is_argument else [each.opts[0], str(plain)]
        elif is_argument and each.required and needed:
            said.append(needed.pop(0))
    return said + needed


def check(result, said):
    if "No module named 'torch'" in result.output:
        pytest.skip("the extra `models` is not installed")
    assert "error in Hearth" not in result.output, (said, result.output)
    assert result.exit_code in (0, 1, 2), (said, result.output)
    assert "Error: Missing" not in result.output, (said, result.output, "it needs a row in NEEDED")
    raw = {*result.output} & {"\x9b", *map(chr, BIDIRECTIONAL)}
    assert not raw, (said, ascii(result.output))


def ran(tmp_path, name, parameter, odd_name):
    odd, plain = tmp_path / odd_name, tmp_path / "plain"
    for path in (odd, plain):
        path.write_text(PROGRAM, "utf-8")
    said = words(name, parameter, odd, plain)
    check(CliRunner().invoke(cli.app, said), said)


@pytest.mark.parametrize(("name", "parameter"), FIRST)
def test_a_command_takes_an_odd_path(tmp_path, name, parameter):
    ran(tmp_path, name, parameter, NAMES[FIRST.index((name, parameter)) % len(NAMES)])


@pytest.mark.slow
@pytest.mark.parametrize("odd_name", NAMES)
@pytest.mark.parametrize(("name", "parameter"), CASES)
def test_every_command_takes_every_path(tmp_path, name, parameter, odd_name):
    ran(tmp_path, name, parameter, odd_name)
