"""Pages of the documentation that are made from the code and the knowledge when it is built: none goes stale."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = (
    "schemas", "storage", "kb", "homes", "simulation", "grounding", "repair", "rendering", "datasets", "scoring",
    "pipelines", "analysis",
)  # fmt: skip


def commands() -> str:
    """Every command's help."""
    from hearth import cli

    lines = ["# Commands", "", "`python cli.py COMMAND`, or `hearth COMMAND` once installed."]
    for section, entries in cli.COMMANDS.items():
        lines += ["", f"## {section}"]
        for name in entries:
            for words, text in _helps(name, cli.load(name)):
                lines += ["", f"### {words}", "", "```text", text.rstrip(), "```"]
    return "\n".join(lines) + "\n"


def _helps(words: str, command: Any) -> Iterator[tuple[str, str]]:
    from click import Context

    yield words, command.get_help(Context(command, info_name=f"hearth {words}", terminal_width=100))
    for name, part in getattr(command, "commands", {}).items():
        yield from _helps(f"{words} {name}", part)


def actions() -> str:
    """Every action that is known."""
    from hearth.kb.loading.load import default

    lines = [
        "# Actions",
        "",
        "What each takes and is in words; `hearth kb action NAME` tells all of one.",
    ]
    lines += ["", "| action | in words | objects | how it can fail |", "|---|---|---|---|"]
    for name, action in sorted(default().actions.items()):
        roles, needed = (
            ", ".join(action.roles) or "none",
            ", ".join(sorted({str(c.code) for c in action.preconditions})),
        )
        words = action.template.format("...", "...")
        lines.append(f"| `{name}` | {words} | {roles} | {needed if action.executed else 'not executed'} |")
    return "\n".join(lines) + "\n"


def objects() -> str:
    """Every class of objects that is known."""
    from hearth.kb.loading.load import default

    lines = ["# Objects", "", "Classes, what they can be and do; `hearth kb show NAME` tells all of one."]
    lines += ["", "| class | category | properties |", "|---|---|---|"]
    for name, kind in sorted(default().objects.items()):
        lines.append(f"| `{name}` | {kind.category} | {', '.join(sorted(kind.properties)).lower()} |")
    return "\n".join(lines) + "\n"


def tables() -> str:
    """The published tables, column by column."""
    from hearth.schemas.tables import TABLES

    lines = ["# Tables", "", "Parquet, typed and nested; `catalog.duckdb` has them as views, with `steps` and `ticks`."]
    for table, schema in TABLES.items():
        lines += ["", f"## {table}", "", "| column | type | meaning |", "|---|---|---|"]
        for column in schema:
            meaning = (column.metadata or {}).get(b"comment", b"").decode()
            kind = str(column.type).replace("|", "\\|")
            lines.append(f"| `{column.name}` | `{kind if len(kind) < 60 else kind[:57] + '...'}` | {meaning} |")
    return "\n".join(lines) + "\n"


def failures() -> str:
    """Every failure code, and what repairs do about it."""
    from hearth.repair.handlers.registry import HANDLERS, UNREPAIRABLE
    from hearth.schemas.failures import Code

    lines = [
        "# Failures",
        "",
        "Everything that can go wrong, as data.",
        "",
        "| code | what repairs do about it |",
        "|---|---|",
    ]
    for code in Code:
        handler = HANDLERS.get(code)
        about = (handler.__doc__ or "").strip().splitlines()[0] if handler else UNREPAIRABLE.get(code, "")
        lines.append(f"| `{code}` | {about} |")
    return "\n".join(lines) + "\n"


def library() -> str:
    """The modules, each with what its docstring says first."""
    import ast

    lines = ["# Library", "", "Imports go one way, down this list. Pages are made from the docstrings."]
    for package in PACKAGES:
        lines += ["", f"## hearth.{package}", ""]
        for file in sorted((ROOT / package).rglob("*.py")):
            about = ast.get_docstring(ast.parse(file.read_text("utf-8"))) or ""
            name = ".".join(file.relative_to(ROOT).with_suffix("").parts)
            if about and file.name != "__init__.py":
                lines.append(f"- [`hearth.{name}`]({name}.md): {about.splitlines()[0]}")
    return "\n".join(lines) + "\n"


def modules() -> dict[str, str]:
    """A page for every module, filled by mkdocstrings."""
    pages = {}
    for package in PACKAGES:
        for file in sorted((ROOT / package).rglob("*.py")):
            if file.name != "__init__.py":
                name = ".".join(file.relative_to(ROOT).with_suffix("").parts)
                pages[f"library/{name}.md"] = f"# {name}\n\n::: hearth.{name}\n"
    return pages


def index() -> str:
    """The README, its links to pictures as they are from here."""
    return (ROOT / "README.md").read_text("utf-8").replace("](docs/", "](")


PAGES: dict[str, Callable[[], str]] = {
    "index.md": index,
    "reference/commands.md": commands,
    "reference/actions.md": actions,
    "reference/objects.md": objects,
    "reference/tables.md": tables,
    "reference/failures.md": failures,
    "library/index.md": library,
}


def on_startup(command: str, dirty: bool) -> None:
    """Lay out the package for mkdocstrings: the checkout is the package's folder, with much in it that is no code."""
    package = ROOT / "build/source/hearth"
    package.mkdir(parents=True, exist_ok=True)
    for path in (*(ROOT / name for name in PACKAGES), *ROOT.glob("*.py")):
        link = package / path.name
        link.unlink(missing_ok=True)
        link.symlink_to(path)


def on_files(files: Any, config: Any) -> Any:
    """Add the pages; mkdocs calls this."""
    from mkdocs.structure.files import File

    made = {name: page() for name, page in PAGES.items()} | modules()
    for name, text in made.items():
        files.append(File.generated(config, name, content=text))
    return files
