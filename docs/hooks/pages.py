"""Pages of the documentation that are generated from the code and the knowledge."""

from __future__ import annotations

import ast
import inspect
import os
import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from pkgutil import resolve_name
from textwrap import dedent
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = (
    "schemas", "storage", "kb", "homes", "simulation", "grounding", "repair", "rendering", "datasets", "scoring",
    "pipelines", "models", "agents", "envs", "challenges", "interop", "analysis", "studies", "web",
)  # fmt: skip

ENTRY_POINTS = {
    "A dataset": (
        "hearth:load", "hearth:Dataset", "hearth:Dataset.sql", "hearth:attach", "hearth:Dataset.to_tensors",
        "hearth:ExecutionGraphs", "hearth.datasets.published_program:Run.graph", "hearth:verify", "hearth:export",
    ),
    "Knowledge": ("hearth:knowledge", "hearth:find", "hearth:understand"),
    "Homes": (
        "hearth:home", "hearth:load_graph", "hearth:Home.from_graph", "hearth:generate", "hearth.homes.lint:lint",
    ),
    "Programs in a home": ("hearth:parse_program", "hearth:bind", "hearth:World", "hearth:run", "hearth:edit"),
    "Agents": ("hearth:Env", "hearth:Env.step", "hearth:Env.observe", "hearth:Env.legal"),
    "Environments of learning libraries": (
        "hearth:TextHome", "hearth:TextHomes",
        "hearth.envs.gymnasium_env:HomeEnv", "hearth.envs.pettingzoo_env:ParallelHome",
    ),
    "Goals and checks": (
        "hearth.challenges.instruction_writer:instruction",
        "hearth.challenges.instruction_reader:read_instruction",
        "hearth:hazards",
        "hearth:holds",
        "hearth:Progress",
        "hearth:read_goal",
        "hearth.simulation.step_explanations:checks",
    ),
    "Environments and variants": (
        "hearth:infer", "hearth:sample", "hearth:augment", "hearth.repair.repair_loop:repair", "hearth:sketch",
    ),
    "Pictures": ("hearth:render", "hearth:record"),
    "Scores": (
        "hearth.scoring.metrics.lcs:score", "hearth:executability", "hearth.scoring.metrics.graph_f1:score",
        "hearth:evaluate",
    ),
    "What is refused": ("hearth:HearthError",),
    "A dataset of one's own": ("hearth:build", "hearth.analysis.corpus_statistics:gather"),
}  # fmt: skip
"""The entry points as `module:name`, in the order of their use."""

PREPARED = """\
import hearth
from pathlib import Path

known = hearth.knowledge()
graph = hearth.load_graph("maple", known)
(fridge,) = [node.id for node in graph.nodes if node.class_name == "fridge"]
home = hearth.home("maple")
world = hearth.World.start(home)
env = hearth.Env()
env.reset("maple")

text = "Fetch milk\\n\\n[Walk] <fridge> (1)\\n[Open] <fridge> (1)\\n[Grab] <milk> (1)\\n"
program = hearth.parse_program(text)
execution = hearth.run(world, hearth.bind(program, world).apply(program))

Path("milk.txt").write_text(text)
folder = hearth.build(["milk.txt"], "milk", homes=("maple",), pictures=0).dataset
"""
"""The definitions that the examples use."""


def python_api() -> str:
    """The entry points, each with its signature, its meaning and its example."""
    lines = ["# Python API", "", "The usual entry points. All examples follow this one, and are tested:"]
    lines += ["", "```python", PREPARED.rstrip(), "```"]
    for group, places in ENTRY_POINTS.items():
        lines += ["", f"## {group}"]
        for place in places:
            about, example = documented(place)
            module = inspect.unwrap(resolve_name(place)).__module__.removeprefix("hearth.")
            more = "" if module == "hearth" else f" [More](library/{module}.md)"
            lines += ["", f"### {place.replace(':', '.')}", "", "```python", signature(place), "```", ""]
            lines += [f"{' '.join(about.split())}{more}", "", "```pycon", example, "```"]
    return "\n".join(lines) + "\n"


def documented(place: str) -> tuple[str, str]:
    """The first paragraph of an entry point's docstring, and its example, or ""."""
    text = inspect.getdoc(resolve_name(place)) or ""
    return text.split("\n\n")[0], inspect.cleandoc(text.partition("\nExamples:\n")[2])


def signature(place: str) -> str:
    """The signature of an entry point, with its defaults as in the code; only the name of a class of another module."""
    found, name = resolve_name(place), place.partition(":")[2]
    made = inspect.isclass(found)
    if made and found.__module__ != "hearth":
        return f"class {name}"
    node = ast.parse(dedent(inspect.getsource(found.__init__ if made else found))).body[0]
    assert isinstance(node, ast.FunctionDef) and node.returns
    taken = re.sub(r"^(self|cls)(, )?", "", ast.unparse(node.args))
    return f"class {name}({taken})" if made else f"{name}({taken}) -> {ast.unparse(node.returns)}"


def commands() -> str:
    """The help of every command."""
    from hearth import cli

    lines = ["# Commands", "", "`hearth COMMAND`; in a checkout `.venv/bin/hearth` or `python cli.py`."]
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
    """All actions."""
    from hearth.kb.action_sets import LATEST
    from hearth.kb.loading.load import default
    from hearth.simulation.actions.registry import EVERY

    latest = default().of_set(LATEST).actions
    number = sum(action.executed for action in latest.values())
    lines = [
        "# Actions",
        "",
        "Objects, text and failures of each; `hearth kb action NAME` shows all about one.",
        f"Action set 3 executes {number} of {len(latest)}, action set 2 {len(EVERY)}. The last column has the failures",
        "of set 3. Moves by metres are executed where the home says where the character stands.",
    ]
    lines += ["", "| action | text | objects | sets | failures |", "|---|---|---|---|---|"]
    for name, action in sorted(latest.items()):
        roles = ", ".join(action.roles) or "none"
        needed = ", ".join(sorted({str(c.code) for c in action.preconditions}))
        words, sets = action.template.format("...", "..."), "2, 3" if name in EVERY else "3"
        lines.append(f"| `{name}` | {words} | {roles} | {sets} | {needed} |")
    return "\n".join(lines) + "\n"


def objects() -> str:
    """All classes of objects."""
    from hearth.kb.loading.load import default

    lines = ["# Objects", "", "Classes with their properties; `hearth kb show NAME` shows all about one."]
    lines += ["", "| class | category | properties |", "|---|---|---|"]
    for name, kind in sorted(default().objects.items()):
        lines.append(f"| `{name}` | {kind.category} | {', '.join(sorted(kind.properties)).lower()} |")
    return "\n".join(lines) + "\n"


def tables() -> str:
    """The published tables with their keys, columns and nested fields; the other views; the macros."""
    from hearth.datasets.format.card import columns
    from hearth.schemas.tables import KEYS, TABLES, comment_of

    lines = ["# Tables", "", *TABLES_ABOUT, "", "![Every table, its key and what it refers to](pictures/tables.svg)"]
    for table, schema in TABLES.items():
        keys = ", ".join(f"`{name}`" for name in KEYS[table])
        refers = "".join(f" `{own}` refers to `{other}`." for own, other in _references(table).items())
        lines += ["", f"## {table}", "", comment_of(schema), "", f"Key: {keys}.{refers}", "", *columns(schema)]
    views, macros = _commented()
    for view, (about, *names) in views.items():
        lines += ["", f"## {view}", "", f"A view. {about}", "", "| column | meaning |", "|---|---|"]
        lines += [f"| `{name}` | {meaning} |" for name, meaning in names]
    lines += ["", "## Macros", "", "| macro | meaning |", "|---|---|"]
    return "\n".join([*lines, *(f"| `{call}` | {about} |" for call, about in macros)]) + "\n"


TABLES_ABOUT = (
    "Parquet, typed and nested. `catalog.duckdb` has a view of every table, further views, and macros. Open it",
    "by its path, from any folder: `duckdb mine/publish/catalog.duckdb`. All that stands here is in it as comments:",
    "",
    "```sql",
    "SELECT column_name, comment FROM duckdb_columns() WHERE table_name = 'programs';",
    "```",
    "",
    "`python docs/hooks/pages.py` writes this page and its diagram, in which the columns of keys are underlined.",
)


def _references(table: str) -> dict[str, str]:
    """Column -> the table and column that it refers to."""
    from hearth.schemas.tables import REFERENCES

    return {own: f"{other}.{key}" for name, own, other, key in REFERENCES if name == table}


def _commented() -> tuple[dict[str, list[Any]], list[tuple[str, str]]]:
    """The views that are no tables, each with its meaning and (column, meaning); the macros as (call, meaning)."""
    from hearth.datasets.format.catalog import statements

    text = (ROOT / "datasets/format/comments.sql").read_text("utf-8")
    views: dict[str, list[Any]] = {}
    macros = []
    for kind, name, about in re.findall(r"^COMMENT ON (VIEW|COLUMN|MACRO(?: TABLE)?) (\S+) IS '(.*)';$", text, re.M):
        view, _, column = name.partition(".")
        meaning = about.replace("''", "'").replace("|", "\\|").replace("<", "&lt;")
        if kind == "VIEW":
            views[view] = [meaning]
        elif kind == "COLUMN":
            views[view].append((column, meaning))
        else:
            (taken,) = re.findall(rf"CREATE MACRO {name}\((.*?)\)", statements())
            macros.append((f"{name}({taken})", meaning))
    return views, macros


LINE, WIDTH, GAP = 18, 210, 60
"""Pixels of the diagram: height of a line, width of a table, space between columns of tables."""


def diagram() -> str:
    """The keys of all tables, as SVG: a table is right of those that it refers to."""
    from hearth.schemas.tables import KEYS, TABLES

    refers = {table: _references(table) for table in TABLES}

    def level(table: str) -> int:
        others = {other.partition(".")[0] for other in refers[table].values()} - {table}
        return max((1 + level(other) for other in others), default=0)

    shown = {table: list(dict.fromkeys((*KEYS[table], *refers[table]))) for table in TABLES}
    levels = {table: level(table) for table in TABLES}
    bottom = dict.fromkeys(levels.values(), 20)
    place: dict[str, tuple[int, int]] = {}
    for table, names in shown.items():
        column = levels[table]
        place[table] = (20 + column * (WIDTH + GAP), bottom[column])
        bottom[column] += LINE * (len(names) + 1) + 30
    boxes, lines = [], []
    for table, (x, y) in place.items():
        names = shown[table]
        boxes.append(f'<rect x="{x}" y="{y}" width="{WIDTH}" height="{LINE * (len(names) + 1) + 6}" rx="4"/>')
        boxes.append(f'<text x="{x + 8}" y="{y + 15}" class="table">{table}</text>')
        for number, name in enumerate(names, 1):
            down = y + 15 + LINE * number
            boxes.append(f'<text x="{x + 8}" y="{down}" class="{"key" if name in KEYS[table] else ""}">{name}</text>')
            other, _, key = refers[table].get(name, "").partition(".")
            if other:
                boxes.append(f'<text x="{x + WIDTH - 8}" y="{down}" class="other">{other}</text>')
            if other and other != table:
                left, top = place[other][0] + WIDTH, place[other][1] + 10 + LINE * (1 + shown[other].index(key))
                middle = (left + x) / 2
                lines.append(f'<path d="M{x},{down - 5} C{middle:g},{down - 5} {middle:g},{top} {left},{top}"/>')
    size = max(x for x, _ in place.values()) + WIDTH + 20, max(bottom.values())
    return "\n".join((
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size[0]} {size[1]}">',
        "<style>text{font:12px sans-serif;fill:#222}.table{font-weight:bold}"
        ".key{text-decoration:underline}.other{fill:#a65;text-anchor:end}rect{fill:#fff;stroke:#777}"
        "path{fill:none;stroke:#a65}</style>",
        f'<rect width="{size[0]}" height="{size[1]}" style="fill:#f6f4f0;stroke:none"/>',
        *lines, *boxes, "</svg>\n",
    ))  # fmt: skip


def failures() -> str:
    """All failure codes, what they mean, and what a person and the repairs do about them."""
    from hearth.schemas.failure_words import REMEDIES, meaning
    from hearth.schemas.failures import Code

    lines = [
        "# Failures",
        "",
        "All codes of failures, of rejects and of faults of files. Where a program fails, `augment` and `repair` try",
        "the repair; a reject has its place, and often what to do, in its row.",
        "",
        "| code | meaning | what to do | repair |",
        "|---|---|---|---|",
    ]
    lines += (f"| `{code}` | {meaning(code)} | {REMEDIES.get(code, '')} | {_repair(code)} |" for code in Code)
    return "\n".join(lines) + "\n"


def _repair(code: Any) -> str:
    from hearth.repair.handlers.registry import HANDLERS, UNREPAIRABLE

    if handler := HANDLERS.get(code):
        return str(handler.__doc__ or "").strip().splitlines()[0]
    return f"none: {UNREPAIRABLE[code]}" if code in UNREPAIRABLE else ""


def library() -> str:
    """The modules with the first lines of their docstrings."""
    lines = ["# Library", "", "Modules import only from packages above. Pages are generated from docstrings."]
    for package in PACKAGES:
        lines += ["", f"## hearth.{package}", ""]
        for file in sorted((ROOT / package).rglob("*.py")):
            about = ast.get_docstring(ast.parse(file.read_text("utf-8"))) or ""
            name = ".".join(file.relative_to(ROOT).with_suffix("").parts)
            if about and file.name != "__init__.py":
                lines.append(f"- [`hearth.{name}`]({name}.md): {about.splitlines()[0]}")
    return "\n".join(lines) + "\n"


def modules() -> dict[str, str]:
    """A page for each module, filled by mkdocstrings."""
    pages = {}
    for package in PACKAGES:
        for file in sorted((ROOT / package).rglob("*.py")):
            if file.name != "__init__.py":
                name = ".".join(file.relative_to(ROOT).with_suffix("").parts)
                pages[f"library/{name}.md"] = f"# {name}\n\n::: hearth.{name}\n"
    return pages


COPIED = {
    "README.md": "index.md",
    "data_raw/homes/README.md": "homes.md",
    "kb/README.md": "knowledge.md",
    "CONTRIBUTING.md": "about/contributing.md",
    "CHANGELOG.md": "about/changes.md",
    "benchmarks/RESULTS.md": "about/speed.md",
}
"""Documents of the checkout that are pages, too."""

ELSEWHERE = {"docs/examples": "examples/own-corpus.md", "NOTICE": "about/notice.md", "LICENSE": "about/notice.md"}
"""What documents link to and the documentation has elsewhere."""


def copied(file: str) -> str:
    """A document of the checkout, its links relative to its place in the documentation."""
    place = Path(COPIED[file]).parent
    known = COPIED | ELSEWHERE

    def moved(match: re.Match[str]) -> str:
        found = known.get(match[1], match[1].removeprefix("docs/"))
        return f"]({os.path.relpath(found, place)})"

    return re.sub(r"\]\(((?:docs/|data_raw/|kb/|[A-Z]+)[^)#\s]*)\)", moved, (ROOT / file).read_text("utf-8"))


def cost() -> str:
    """What large datasets and many episodes take."""
    return str(beside("cost_page").page())


def beside(name: str) -> Any:
    """Another script of this folder; mkdocs does not put it on the path."""
    from importlib.util import module_from_spec, spec_from_file_location

    found = spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    assert found and found.loader
    loaded = module_from_spec(found)
    found.loader.exec_module(loaded)
    return loaded


def notice() -> str:
    """The sources of facts, and the licence."""
    texts = [(name, (ROOT / name).read_text("utf-8").rstrip()) for name in ("NOTICE", "LICENSE")]
    return "# Sources and licences\n" + "".join(f"\n## {name}\n\n```text\n{text}\n```\n" for name, text in texts)


PAGES: dict[str, Callable[[], str]] = {
    **{page: partial(copied, file) for file, page in COPIED.items()},
    "about/notice.md": notice,
    "about/cost.md": cost,
    "python-api.md": python_api,
    "reference/commands.md": commands,
    "reference/actions.md": actions,
    "reference/objects.md": objects,
    "reference/failures.md": failures,
    "library/index.md": library,
}


WRITTEN: dict[str, Callable[[], str]] = {"tables.md": tables, "pictures/tables.svg": diagram}
"""Pages and pictures of `docs/` that are kept in the checkout; `python docs/hooks/pages.py` writes them."""


def on_startup(command: str, dirty: bool) -> None:
    """Link the package for mkdocstrings, because the checkout holds more than the package."""
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


if __name__ == "__main__":
    for name, page in WRITTEN.items():
        (ROOT / "docs" / name).write_text(page(), "utf-8")
