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
    "pipelines", "models", "agents", "envs", "llm", "challenges", "interop", "analysis", "studies", "web",
)  # fmt: skip

ENTRY_POINTS = {
    "A dataset": (
        "hearth:load", "hearth:Dataset", "hearth:Dataset.sql", "hearth:attach", "hearth:Dataset.to_tensors",
        "hearth:ExecutionGraphs", "hearth.datasets.published_program:Run.graph", "hearth:verify", "hearth:export",
    ),
    "Knowledge": ("hearth:knowledge", "hearth:find", "hearth:understand"),
    "Homes": (
        "hearth:home", "hearth:load_graph", "hearth:Home.from_graph", "hearth:generate", "hearth.homes.lint:lint",
        "hearth.interop.scene_graphs.reading:read_scene", "hearth.interop.bddl.problem:read_problem",
        "hearth.schemas.graph_json_schema:graph_schema",
    ),
    "Programs in a home": (
        "hearth:parse_program", "hearth:parse_steps", "hearth:bind", "hearth:World", "hearth:run", "hearth:edit",
    ),
    "Agents": ("hearth:Env", "hearth:Env.step", "hearth:Env.observe", "hearth:Env.legal"),
    "Environments of learning libraries": (
        "hearth:TextHome", "hearth:TextHomes", "hearth:TextEpisode",
        "hearth.envs.gymnasium_env:HomeEnv", "hearth.envs.pettingzoo_env:ParallelHome",
    ),
    "Language models": ("hearth:Endpoint", "hearth:run_tasks", "hearth.simulation.actions.legal:Legal.grammar"),
    "Goals and checks": (
        "hearth.challenges.instruction_writer:instruction",
        "hearth.challenges.instruction_reader:read_instruction", "hearth.interop.alfred_goals:alfred_goal",
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
"""Targets of links in documents that the documentation has under another address."""


def copied(file: str) -> str:
    """A document of the checkout, its links relative to its place in the documentation."""
    place = Path(COPIED[file]).parent
    known = COPIED | ELSEWHERE

    def moved(match: re.Match[str]) -> str:
        found = known.get(match[1], match[1].removeprefix("docs/"))
        return f"]({os.path.relpath(found, place)})"

    return re.sub(r"\]\(((?:docs/|data_raw/|kb/|[A-Z]+)[^)#\s]*)\)", moved, (ROOT / file).read_text("utf-8"))


def cost() -> str:
    """Return the page of costs: large datasets and many episodes."""
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


def tables() -> str:
    """Return the page of the published tables."""
    return str(beside("table_pages").tables())


def diagram() -> str:
    """Return the diagram of the published tables, as SVG."""
    return str(beside("table_pages").diagram())


def prompts() -> str:
    """Return the page of all prompts, with their fingerprints."""
    from hearth.llm.prompt_pages import every_page

    intro = """\
        # Prompts

        The words that language models are given. A fingerprint is a digest of a page's file; results name it, so that a
        score says under which words it was made. `hearth llm prompts` prints the same.
        """
    parts = [dedent(intro)]
    for role, each in every_page().items():
        parts.append(
            f"\n## {role}\n\n`{each.name}`, fingerprint `{each.fingerprint}`\n\n```yaml\n{each.text.strip()}\n```\n"
        )
    return "".join(parts)


WRITTEN: dict[str, Callable[[], str]] = {
    "tables.md": tables,
    "pictures/tables.svg": diagram,
    "prompts.md": prompts,
}
"""Pages and pictures of `docs/` that are kept in the checkout; `python docs/hooks/pages.py` writes them."""


def on_startup(command: str, dirty: bool) -> None:
    """Link the package for mkdocstrings, because the checkout holds more than the package."""
    package = ROOT / "build/source/hearth"
    package.mkdir(parents=True, exist_ok=True)
    for path in (*(ROOT / name for name in PACKAGES), *ROOT.glob("*.py")):
        link = package / path.name
        link.unlink(missing_ok=True)
        link.symlink_to(path)


def of_the_site(text: str) -> str:
    """Return a page of `docs/` in which links to documents of the checkout lead to their pages."""
    return re.sub(r"\]\(\.\./([^)#\s]+)", lambda match: f"]({COPIED.get(match[1], '../' + match[1])}", text)


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Rewrite the links of a page at the top; mkdocs calls this."""
    return of_the_site(markdown) if "/" not in page.file.src_uri else markdown


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
