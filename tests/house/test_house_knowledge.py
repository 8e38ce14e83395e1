"""A dataset, a build's settings or a command names the knowledge; code below commands gets it as an argument."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LOADING = "hearth.kb.loading.load"

ENTRIES = ("commands", "cli.py", "__init__.py", "docs", "benchmarks", "tests")
"""Places where programs begin: they may take our own knowledge."""

READS = {
    "kb/tools/compare.py": "another's knowledge, to be compared",
    "datasets/dataset_knowledge.py": "what a dataset was made with",
    "pipelines/engine/build_context.py": "what a build was asked to use",
}
"""Files below that read knowledge because something names it."""

RECOGNISES = {
    "kb/language/recognition_knowledge.py": "how forms of text are recognized where no reading was given a knowledge",
}
"""The one file in which readers find the knowledge that a command or build gave to a reading."""

NAMED = {
    "challenges/household.py": "tasks that are named by their ids alone",
    "challenges/household_as_challenge.py": "published tasks, which are defined with our knowledge",
    "challenges/task_files.py": "published tasks, which are defined with our knowledge",
    "pipelines/readers/plans_in_words.py": "an entry point that works without a knowledge",
    "analysis/everyday_instructions.py": "instructions with goals that are written for our homes",
    "challenges/array_homes.py": "published tasks, which are defined with our knowledge",
    "challenges/language_runs.py": "published tasks, which are defined with our knowledge",
    "models/reading/reader.py": "its tables of requests, which name our classes and acts",
    "models/reading/reader_recall.py": "the same",
    "challenges/named_task_envs.py": "tasks that `gym.make` names",
    "challenges/text_episode.py": "tasks and homes that programs name over HTTP",
    "interop/virtualhome/symbolic_classes.py": "classes of VirtualHome's package, which were made without a knowledge",
    "challenges/tasks.py": "the instruction of a published task",
    "envs/session.py": "homes that `gym.make` names",
    "envs/text_homes.py": "tasks without a knowledge of their own",
}
"""Files that make published things of ours by their names; these are defined with our knowledge."""

OPTIONAL = {
    ("simulation/env.py", "knowledge"): "without it, a home is refused that is only named",
    ("pipelines/readers/plans_in_words.py", "knowledge"): "the entry point `hearth.parse_steps` reads with ours",
    ("challenges/household.py", "knowledge"): "a published task has ours",
    ("interop/virtualhome/symbolic_classes.py", "knowledge"): "VirtualHome's package has no such argument",
    ("envs/text_homes.py", "knowledge"): "a published task has ours",
}
"""Parameters for knowledge that may be left out, and what is then not possible."""

FILES = [
    path
    for path in sorted(ROOT.rglob("*.py"))
    if not any(part.startswith(".") for part in path.relative_to(ROOT).parts)
    and path.relative_to(ROOT).parts[0] not in (*ENTRIES, "build")
]
NAMES = [path.relative_to(ROOT).as_posix() for path in FILES]


def loaded(tree):
    """Return the names that a file takes from the module that reads knowledge; the module itself gives all."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == LOADING:
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module == "hearth.kb.loading":
            yield from ("*" for alias in node.names if alias.name == "load")
        elif isinstance(node, ast.Import):
            yield from ("*" for alias in node.names if alias.name == LOADING)


def optional(tree):
    """Parameters for knowledge that a caller may leave out, by the line of their function."""
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            with_default = node.args.args[len(node.args.args) - len(node.args.defaults) :]
            keyword = [arg for arg, value in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True) if value]
            for arg in (*with_default, *keyword):
                if arg.annotation is not None and "Knowledge" in ast.unparse(arg.annotation):
                    yield node.lineno, arg.arg


def made(tree):
    """The lines that make a `Knowledge` themselves."""
    calls = (node for node in ast.walk(tree) if isinstance(node, ast.Call))
    return [call.lineno for call in calls if ast.unparse(call.func) == "Knowledge"]


def test_there_is_something_to_look_at():
    assert len(FILES) > 250
    assert {*READS, *RECOGNISES, *NAMED} < set(NAMES)


def test_knowledge_is_passed_in():
    wrong = {}
    for path, name in zip(FILES, NAMES, strict=True):
        allowed = {"FILES", "digest", "files_of"} | ({"overlaid", "load"} if name in READS else set())
        allowed |= {"default"} if name in RECOGNISES | NAMED else set()
        tree = ast.parse(path.read_text())
        left_out = [(line, arg) for line, arg in optional(tree) if (name, arg) not in OPTIONAL]
        found = [*(set(loaded(tree)) - allowed), *left_out, *made(tree)]
        if found and name != "kb/loading/load.py":
            wrong[name] = found
    assert not wrong


@pytest.mark.parametrize(
    "code",
    [
        "from hearth.kb.loading.load import default\ndefault()",
        "from hearth.kb.loading import load\nload.default()",
        "import hearth.kb.loading.load as kb\nkb.default()",
    ],
)
def test_every_way_to_our_own_is_seen(code):
    assert {"default", "*"} & set(loaded(ast.parse(code)))


def test_a_parameter_that_may_be_left_out_is_seen():
    code = "def f(a, knowledge: Knowledge | None = None): ...\ndef g(*, known: Knowledge = OURS): ..."
    assert list(optional(ast.parse(code))) == [(1, "knowledge"), (2, "known")]
