"""Numbers of the command line that are none, or longer than a clock takes, are a usage error of every command."""

import pytest
import typer
from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code


def commands(group, *names):
    """Yield the names of each command, and the command."""
    if not hasattr(group, "list_commands"):
        yield names, group
        return
    context = typer.Context(group)
    for name in group.list_commands(context):
        yield from commands(group.get_command(context, name), *names, name)


NUMBERS = [
    (*names, option.opts[0])
    for names, command in commands(typer.main.get_command(cli.app))
    for option in command.params
    if option.type_descriptor.annotation is float
]
TIMES = [words for words in NUMBERS if words[-1] in ("--within", "--time-limit", "--seconds", "--minutes")]


def refused(words, number):
    """Return whether a command refuses a number of an option, before it looks at anything else."""
    result = CliRunner().invoke(cli.app, [*words[:-1], f"{words[-1]}={number}"])
    return result.exit_code == 2 and f"'{words[-1]}'" in result.output.replace("\n", " ")


def test_the_options_in_seconds_are_found():
    assert {words[-1] for words in TIMES} == {"--within", "--time-limit", "--seconds", "--minutes"}
    assert ("build", "--time-limit") in [words[-2:] for words in TIMES]
    assert len(TIMES) > 8


@pytest.mark.parametrize("words", NUMBERS, ids=" ".join)
def test_a_number_that_is_none_is_a_usage_error(words):
    assert all(refused(words, number) for number in ("inf", "-inf", "nan", "1e400"))


@pytest.mark.parametrize("words", TIMES, ids=" ".join)
def test_a_time_below_zero_or_beyond_a_year_is_a_usage_error(words):
    assert all(refused(words, number) for number in ("-1", "1e30", "1e300"))


@pytest.mark.parametrize("seconds", [float("inf"), float("nan"), -1.0, 1e300])
def test_a_time_limit_that_is_none_is_a_fault_from_python_too(seconds, tmp_path):
    with pytest.raises(HearthError) as caught:
        hearth.build(out=tmp_path / "out", time_limit=seconds)
    assert caught.value.diagnostics[0].code is Code.BAD_ARGUMENT
