"""The command line as a whole: help with examples, JSON everywhere, errors without tracebacks, exit statuses."""

import importlib
import json
import re
import subprocess
import sys
from inspect import signature
from pathlib import Path
from typing import Annotated, get_origin

import pytest
import typer
from typer.testing import CliRunner

from hearth import __version__, cli
from hearth.commands import options
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

ROOT = Path(__file__).resolve().parents[2]


def call(*arguments, **options):
    return CliRunner().invoke(cli.app, [str(argument) for argument in arguments], **options)


def every_command():
    """The words of each command that does something: `("kb", "show")`."""
    for name in cli.COMMANDS_BY_NAME:
        yield from words_of((name,), cli.load(name))


def words_of(words, command):
    """The words of each command of a group, and of the groups within it: `("challenge", "eai", "table")`."""
    names = getattr(command, "commands", None)
    if not names:
        yield words
    for name, each in (names or {}).items():
        yield from words_of((*words, name), each)


COMMANDS = list(every_command())

DOCUMENTS = {("kb", "export"), ("render-program",), ("render-sheet",)}
"""Commands whose output is a document or pictures in a format of their own."""


@pytest.mark.parametrize("words", [("check",), ("kb", "find"), ()], ids=" ".join)
@pytest.mark.parametrize(("script", "name"), [("cli.py", "python cli.py"), ("/usr/bin/hearth", "hearth")])
def test_help_shows_the_name_that_was_typed(monkeypatch, capsys, words, script, name):
    monkeypatch.setattr("sys.argv", [script, *words, "--help"])
    with pytest.raises(SystemExit):
        cli.main()
    shown = capsys.readouterr().out
    assert f"Usage: {' '.join((name, *words))} [OPTIONS]" in shown
    assert f"  {' '.join((name, *words))} " in shown.partition("Example")[2]
    assert name == "python cli.py" or "cli.py" not in shown


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_help_shows_an_example_and_json(words):
    result = call(*words, "--help")
    assert result.exit_code == 0, result.output
    assert f"hearth {' '.join(words)}" in result.output.partition("Example")[2], "no example of this command"
    assert "--json" in result.output or words in DOCUMENTS
    assert "\b" not in result.output


@pytest.mark.parametrize("words", COMMANDS, ids=" ".join)
def test_help_has_plain_names_and_whole_sentences(words):
    shown = call(*words, "--help").output
    usage = " ".join(shown.partition("\n\n")[0].split()).partition("[OPTIONS]")[2]
    assert all(re.fullmatch(r"\[?[A-Z][A-Z|:.*_-]*\]?(\.\.\.)?", name) for name in usage.split()), usage
    assert not re.search(r"<[a-z]", shown.partition("Arguments:")[2].partition("Options:")[0])
    if len(words) == 2:
        listed = call(words[0], "--help").output.partition("Commands:")[2]
        assert not re.search(r"\.\.\.$", listed, re.MULTILINE)


def test_usage_of_arguments_that_may_be_left_out_or_given_several_times():
    assert "check [OPTIONS] FILE...\n" in call("check", "--help").output
    assert "build [OPTIONS] [SOURCE]...\n" in call("build", "--help").output
    assert "synthesize [OPTIONS] [N]\n" in call("corpus", "synthesize", "--help").output


def test_every_parameter_has_its_entry_and_every_entry_its_parameter():
    """Entries of `commands/options.yaml` that nothing asks for are left over; parameters without one have no help."""
    functions = {}
    for name, entry in cli.COMMANDS_BY_NAME.items():
        module, attribute = entry.place.split(":")
        cli.load(name)
        found = getattr(importlib.import_module(f"hearth.commands.{module}"), attribute)
        each = [found]
        if isinstance(found, typer.Typer):
            apps = (found, *(group.typer_instance for group in found.registered_groups))
            each = [one.callback for app in apps for one in app.registered_commands]
        functions.update({(one.__module__.rpartition(".")[2], one.__name__): one for one in each})
    used = set()
    for (module, function), command in functions.items():
        for parameter in signature(options.described(command)).parameters.values():
            if parameter.annotation is not typer.Context and parameter.kind is not parameter.VAR_KEYWORD:
                places = (module, f"{function}.{parameter.name}"), (module, parameter.name), ("shared", parameter.name)
                found = [(of, key) for of, key in places if key in options._table().get(of, {})]
                assert found, f"{module}.{function}: `{parameter.name}` has no entry in commands/options.yaml"
                assert get_origin(parameter.annotation) is Annotated
                used.add(found[0])
    assert used == {(of, key) for of, entries in options._table().items() for key in entries}


def test_help_has_a_line_for_every_command():
    result = call("--help")
    assert result.exit_code == 0
    for name, entry in cli.COMMANDS_BY_NAME.items():
        assert f"  {name} " in result.output
        assert entry.line.endswith(".")


def test_no_command_shows_the_help_and_is_a_usage_error():
    result = call()
    assert result.exit_code == 2
    assert "check" in result.output and "Traceback" not in result.output


def test_version():
    assert call("--version").output.startswith(f"hearth {__version__} ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["chekc"], "Did you mean `check`?"),
        (["nothing-like-it"], "Unknown command `nothing-like-it`."),
        (["check"], "Missing argument"),
        (["check", "--nope", "x"], "--nope"),
        (["run", "x", "--seed", "many"], "--seed"),
        (["score", "dataset", "x", "y", "--part", "train"], "name the split whose part it is with --split"),
    ],
)
def test_wrong_usage_is_status_2(arguments, message):
    result = call(*arguments)
    assert result.exit_code == 2
    assert message in result.output
    assert "Traceback" not in result.output


@pytest.fixture
def failing(monkeypatch):
    """Makes `doctor` fail in a chosen way."""

    def make(error):
        def doctor(as_json: bool = typer.Option(False, "--json")) -> None:
            raise error

        single = typer.Typer(add_completion=False, rich_markup_mode=None)
        single.command("doctor")(doctor)
        monkeypatch.setattr(cli, "load", lambda name: typer.main.get_command(single))

    return make


def test_bad_input_is_printed_and_status_1(failing):
    failing(HearthError.of(Code.BAD_ARCHIVE, "not a zip", file="a.zip", suggestion="get it again"))
    result = call("doctor")
    assert result.exit_code == 1
    assert result.output == "error[BAD_ARCHIVE]: not a zip\n   --> a.zip\n    = get it again\n"


def test_bad_input_is_json_where_json_was_asked_for(failing):
    failing(HearthError.of(Code.BAD_ARCHIVE, "not a zip", file="a.zip"))
    result = call("doctor", "--json")
    assert result.exit_code == 1
    (fault,) = json.loads(result.stdout)["errors"]
    assert (fault["code"], fault["file"]) == ("BAD_ARCHIVE", "a.zip")


@pytest.mark.parametrize("error", [FileNotFoundError(2, "No such file", "gone.txt"), PermissionError(13, "No", "x")])
def test_a_file_of_the_user_that_cannot_be_opened_is_bad_input(failing, error):
    failing(error)
    result = call("doctor")
    assert result.exit_code == 1
    assert result.output.startswith("error[") and error.filename in result.output


def test_a_fault_of_ours_says_so_and_how_to_see_more(failing):
    failing(KeyError("walk"))
    result = call("doctor")
    assert result.exit_code == 1
    assert "KeyError: 'walk'" in result.output and "--debug" in result.output
    assert "Traceback" not in result.output


def test_debug_lets_the_error_through(failing):
    failing(KeyError("walk"))
    assert isinstance(call("--debug", "doctor").exception, KeyError)


def script(*command, cwd):
    return subprocess.run(
        [sys.executable, *map(str, command)], cwd=cwd, capture_output=True, text=True, check=False, timeout=60
    )


def test_the_script_works_from_anywhere_whatever_is_in_the_way(tmp_path):
    """A module of the user's that is named as one of ours does not disturb it."""
    (tmp_path / "schemas.py").write_text("raise SystemExit('the wrong schemas')\n")
    result = script(ROOT / "cli.py", "--version", cwd=tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith("hearth ")


def test_the_script_says_what_to_do_where_nothing_is_set_up(tmp_path):
    (tmp_path / "cli.py").write_text((ROOT / "cli.py").read_text())
    result = script("-S", tmp_path / "cli.py", "--version", cwd=tmp_path)
    assert result.returncode == 1
    assert "make setup" in result.stderr and "Traceback" not in result.stderr


def test_the_script_goes_on_under_the_environment_beside_it(tmp_path):
    (tmp_path / "cli.py").write_text((ROOT / "cli.py").read_text())
    python = tmp_path / ".venv/bin/python"
    python.parent.mkdir(parents=True)
    python.write_text("#!/bin/sh\necho went on with: $(basename $1) $2\n")
    python.chmod(0o755)
    result = script("-S", tmp_path / "cli.py", "--version", cwd=tmp_path)
    assert result.stdout == "went on with: cli.py --version\n"
