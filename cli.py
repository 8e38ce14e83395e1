"""The command line: `python cli.py COMMAND` in a checkout, or `hearth COMMAND` once installed.

Each command is a function of `hearth.commands`; its module is imported when it is called, so that `--help` is quick.
Bad input becomes a message and an exit status here, for all commands.
"""

import io
import os
import sys
from pathlib import Path
from typing import Any, NamedTuple, NoReturn

_ROOT = Path(__file__).resolve().parent


def _find_package() -> None:
    """Restart with the Python of `.venv` if this one has no Hearth (`python cli.py` with the system's Python)."""
    import importlib.util

    if importlib.util.find_spec("hearth") and importlib.util.find_spec("typer"):
        return
    python = _ROOT / ".venv/bin/python"
    if python.exists() and Path(sys.prefix).resolve() != python.parent.parent.resolve():
        os.execv(python, [str(python), *sys.argv])
    sys.exit("Hearth is not set up here: run `make setup` (or `pip install .`) first.")


if __name__ == "__main__":
    # The folder of a script is first in the path, where `schemas` or `version` would hide modules of those names.
    sys.path[:] = [entry for entry in sys.path if Path(entry or ".").resolve() != _ROOT]
    _find_package()

import typer
from typer.core import TyperGroup

from hearth.commands.command_line_name import program_name, show_name
from hearth.commands.plain_help import make_plain
from hearth.commands.standard_streams import check_streams, end_without_output
from hearth.schemas.diagnostics import Diagnostic, HearthError
from hearth.schemas.failures import Code


class Entry(NamedTuple):
    """The place of a command (`module:function` or `module:app` of `hearth.commands`) and its line in `--help`."""

    place: str
    line: str


COMMANDS: dict[str, dict[str, Entry]] = {
    "Make a dataset": {
        "build": Entry("build:build", "Run the stages one after another and publish a dataset."),
        "ingest": Entry("build:ingest", "Read descriptions and programs of any known form."),
        "validate": Entry("build:validate", "Check every program against the action grammar."),
        "sample": Entry("build:sample", "Place every program in a home where it runs."),
        "augment": Entry("build:augment", "Perturb the preconditions of programs, run them, and repair the failures."),
        "render": Entry("build:render", "Picture programs while they run."),
        "publish": Entry("build:publish", "Write the tables, the catalog and the manifest."),
    },
    "Use a dataset": {
        "query": Entry("query:query", "Query a published dataset in SQL."),
        "verify": Entry(
            "verify:verify", "Check a dataset: hashes, counts, references, and a replay of every execution."
        ),
        "diff": Entry("diff:diff", "Print the differences between two datasets, by table and by row."),
        "export": Entry(
            "export:export", "Write a dataset in another form: release, text, JSON Lines, code, graphs, PDDL."
        ),
        "plan": Entry("plan:plan", "Solve planning problems of a dataset, and run the plans."),
        "report": Entry("report:report", "Write a dataset as static HTML that needs no network."),
        "augmented": Entry("augmented:augmented", "Compare an augmented dataset with the thesis's, table 5.1."),
        "score": Entry("score:app", "Score predicted programs against references."),
        "model": Entry("model:app", "Models that write programs: train, predict, score, show."),
        "llm": Entry("llm:app", "Language models: probe a server, serve a small model."),
        "corpus": Entry("corpus:app", "Descriptions and programs: statistics, synthesis, ratings, error detection."),
    },
    "Try a program": {
        "check": Entry("check:check", "Check program files and underline the faults."),
        "run": Entry("run:run", "Run a program in a home and print the changes of each step."),
        "hazards": Entry("hazards:hazards", "Find the dangers and the lasting harm of a program in a home."),
        "repair": Entry("repair:repair", "Perturb the preconditions of a program, and show its repairs."),
        "sketch": Entry("sketch:sketch", "Print the steps of a program that do not depend on the environment."),
        "replay": Entry("replay:replay", "Run a release's programs, or episodes, again, and compare with the stored."),
        "play": Entry("play:play", "Play an episode in a home: you, programs in any language, or language models."),
    },
    "Help somebody": {
        "challenge": Entry("challenge:app", "Watch-And-Help: tasks, runs of agents, scores that can be verified."),
    },
    "Ask people": {
        "serve": Entry("serve:serve", "The server where people annotate, play and judge, and the researcher's desk."),
        "mcp": Entry("mcp:mcp", "Serve a home to agents over the Model Context Protocol (MCP)."),
        "study": Entry("study:app", "Studies with people: check, simulate, prepare, export, report."),
    },
    "Make pictures": {
        "render-program": Entry("render:program", "Picture one program step by step, with a contact sheet."),
        "render-visible": Entry("render:visible", "Count the steps whose objects are visible, over many programs."),
        "render-gallery": Entry("render:gallery", "Picture steps in as many homes, in one sheet."),
        "render-sheet": Entry("render:sheet", "Draw every model, variant and state."),
    },
    "Look around": {
        "kb": Entry("kb:app", "The knowledge of actions and objects."),
        "home": Entry("home:app", "The homes: list, show and check them."),
        "environment": Entry(
            "environment:app", "Preconditions of programs, sampled environments, and their distribution."
        ),
        "doctor": Entry("doctor:doctor", "Check libraries, codecs, disk and data on this machine."),
    },
}
"""Every command. To add one: a function in `commands/`, and a row here."""

COMMANDS_BY_NAME = {name: entry for section in COMMANDS.values() for name, entry in section.items()}


def load(name: str) -> Any:
    """Return the command of that name; imports its module."""
    import importlib

    module, attribute = COMMANDS_BY_NAME[name].place.split(":")
    target = getattr(importlib.import_module(f"hearth.commands.{module}"), attribute)
    described = importlib.import_module("hearth.commands.options").described
    if isinstance(target, typer.Typer):
        for app in (target, *(group.typer_instance for group in target.registered_groups if group.typer_instance)):
            for each in app.registered_commands:
                each.callback = described(each.callback)
        target.rich_markup_mode = None
        command: Any = typer.main.get_group(target)
        command.name = name
    else:
        target = described(target)
        single = typer.Typer(add_completion=False, rich_markup_mode=None)
        single.command(name)(target)
        command = typer.main.get_command(single)
    show_name(command)
    make_plain(command)
    return command


class Commands(TyperGroup):
    """The commands of `COMMANDS`, each loaded when it is called; prints bad input and sets the status."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Every name, in the order of the table."""
        return list(COMMANDS_BY_NAME)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return the command of that name, or None."""
        return load(cmd_name) if cmd_name in COMMANDS_BY_NAME else None

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """Find the command, or suggest the most similar name."""
        if args and args[0] not in COMMANDS_BY_NAME and not args[0].startswith("-"):
            import difflib

            close = difflib.get_close_matches(args[0], list(COMMANDS_BY_NAME), n=1)
            ctx.fail(f"Unknown command `{args[0]}`." + (f" Did you mean `{close[0]}`?" if close else ""))
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """List the commands by section, without importing them."""
        for title, entries in COMMANDS.items():
            with formatter.section(title):
                formatter.write_dl([(name, entry.line) for name, entry in entries.items()])

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Store whether --json was given, so that an error can be JSON too."""
        ctx.meta["hearth.json"] = "--json" in args
        try:
            return super().parse_args(ctx, args)
        except Exception as error:
            _is_of_typer(error)
            raise

    def invoke(self, ctx: Any) -> Any:
        """Run the command; bad input is printed and ends with status 1, an unknown name with status 2."""
        try:
            return super().invoke(ctx)
        except (BrokenPipeError, typer.Abort, typer.Exit):
            raise
        except KeyboardInterrupt as stop:
            if isinstance(fault := getattr(stop, "fault", None), HearthError):
                _fail(fault, as_json=ctx.meta["hearth.json"])
            kept = ctx.invoked_subcommand in COMMANDS["Make a dataset"]
            after = " Complete parts are kept: the same command continues from there." if kept else ""
            sys.stderr.write(f"Stopped.{after}\n")
            raise typer.Exit(TERMINATED if isinstance(stop, Terminated) else STOPPED) from None
        except Exception as error:
            if ctx.params.get("debug") or _is_of_typer(error):
                raise
            _fail(error, as_json=ctx.meta["hearth.json"])


STOPPED = 128 + 2
"""The status after an interrupt (signal 2) from the keyboard, as in shells."""

TERMINATED = 128 + 15
"""The status of a process that was asked to end (signal 15)."""


class Terminated(KeyboardInterrupt):
    """The command was asked to end: it stops as at the keyboard."""


def _is_of_typer(error: Exception) -> bool:
    """Return whether Typer prints the error itself: wrong usage, an invalid option. Its words are then harmless."""
    from hearth.schemas.terminal import shown

    if not hasattr(error, "format_message"):
        return False
    for name in ("message", "param_hint", "option_name"):
        if isinstance(text := getattr(error, name, None), str):
            setattr(error, name, shown(text.removeprefix(LIBRARYS)))
    return True


LIBRARYS = "Value error, "
"""Words that the library for types puts before the reason."""


def _fail(error: Exception, *, as_json: bool) -> NoReturn:
    """Print an error, for all commands."""
    from hearth.commands import output

    if isinstance(error, HearthError):
        faults = error.diagnostics
    elif isinstance(error, OSError):
        faults = (_of_the_machine(error),)
    else:
        what = f"{type(error).__name__}: {error}"
        output.note(f"An error in Hearth, not in your input: {what}\n`--debug` before the command shows where.")
        raise typer.Exit(output.BAD_INPUT) from error
    if as_json:
        output.emit({"errors": faults})
    else:
        output.report(faults)
    asked = all(fault.code in NAMED and not fault.file for fault in faults)
    raise typer.Exit(output.USAGE if asked else output.BAD_INPUT) from error


NAMED = (Code.UNKNOWN_HOME, Code.UNKNOWN_ID, Code.UNSUPPORTED_FILE)
"""Faults of a name in an option, if they have no file."""


def _of_the_machine(error: OSError) -> Diagnostic:
    """Return the diagnostic of a file that is missing or can't be read, or of a folder that can't be written."""
    import errno

    name = str(error.filename or "")
    full = error.errno in (errno.EROFS, errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
    forbidden = error.errno in (errno.EACCES, errno.EPERM) and not Path(name).is_file()
    code = Code.UNWRITABLE if full or forbidden else Code.MISSING_FILE
    return Diagnostic(code, str(error.strerror or error).lower(), file=name)


app = typer.Typer(
    cls=Commands,
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)


def _print_version(asked: bool) -> None:
    if asked:
        from hearth.version import ACTION_SET, VERSION

        typer.echo(f"hearth {VERSION} ({ACTION_SET})")
        raise typer.Exit


@app.callback()
def _options(
    version: bool = typer.Option(
        False, "--version", callback=_print_version, is_eager=True, help="Print the version and exit."
    ),
    debug: bool = typer.Option(False, "--debug", envvar="HEARTH_DEBUG", help="Show the traceback of an error."),
) -> None:
    """Hearth turns what people say they do at home into datasets that machines can run.

    \b
    Examples:
      hearth check morning.txt        underline the faults of a program
      hearth build --out data_out     make a dataset of the starter corpus
      hearth COMMAND --help           the options of a command, with an example
    """


def _run(command: Any) -> None:
    """Run the command to the last byte of its output: what the system refuses then has no command to say it."""
    try:
        try:
            command(prog_name=program_name())
        finally:
            sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:  # every other error of the machine was said; `--debug` lets errors through
        if "--debug" in sys.argv or os.environ.get("HEARTH_DEBUG"):
            raise
        end_without_output(str(error.strerror or error).lower())


def main() -> None:
    """Run the command line. Statuses: 0 done, 1 bad input, 2 wrong usage, 130 and 143 stopped."""
    import signal

    def stop(number: int, frame: object) -> NoReturn:
        raise Terminated

    signal.signal(signal.SIGTERM, stop)
    check_streams()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # half characters, and terminals that have few
    command = typer.main.get_command(app)
    show_name(command)
    try:
        _run(command)
    finally:  # from here on a signal to end has nobody to tell
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


if __name__ == "__main__":
    main()
