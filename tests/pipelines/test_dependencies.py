"""The files that decide a stage's output are found from the imports of its module."""

import ast

import pytest

from hearth.pipelines.engine import dependencies
from hearth.pipelines.engine.dependencies import ROOT, code_digest, files_of, imports

MODULES = sorted(path for package in ROOT.glob("*/__init__.py") for path in package.parent.rglob("*.py"))
STAGES = ("ingest", "validate", "sample", "augment", "render", "publish")


def parsed(node):
    """The imports of a syntax tree, those for types left out: the slow, plain version."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and isinstance(child.test, ast.Name) and child.test.id == "TYPE_CHECKING":
            continue
        if isinstance(child, ast.ImportFrom) and child.module.startswith("hearth"):
            yield child.module
            yield from (f"{child.module}.{alias.name}" for alias in child.names)
        elif isinstance(child, ast.Import):
            yield from (alias.name for alias in child.names if alias.name.startswith("hearth"))
        else:
            yield from parsed(child)


def test_imports_are_those_of_the_syntax_tree():
    for path in MODULES:
        text = path.read_text()
        assert set(imports(text)) == set(parsed(ast.parse(text))), path


def data_of(stage):
    return {name for name in files_of(f"hearth.pipelines.{stage}") if not name.endswith(".py")}


@pytest.mark.parametrize("stage", STAGES)
def test_a_stage_depends_on_itself_and_on_the_schemas(stage):
    assert {f"pipelines/{stage}.py", "pipelines/engine/stage.py", "schemas/tables.py"} <= files_of(
        f"hearth.pipelines.{stage}"
    )


def test_data_files_count_with_the_modules_that_name_them():
    knowledge = {
        path.relative_to(ROOT).as_posix() for path in (ROOT / "kb/data").iterdir() if path.suffix in (".csv", ".yaml")
    }
    homes = {path.relative_to(ROOT).as_posix() for path in (ROOT / "data_raw/homes").glob("*.[yc][as][mv]*")}
    assert len(knowledge) > 10 and len(homes) > 10
    others = {"data_raw/forms.csv", "schemas/keys.yaml", "grounding/preconditions/usual_states.yaml"}
    assert data_of("sample") == knowledge | homes | others
    assert data_of("augment") == data_of("sample") | {"repair/perturbations.yaml"}
    names = ("catalog.sql", "comments.sql", "croissant.yaml", "datasheet.yaml", "earlier.yaml")
    described = {f"datasets/format/{name}" for name in names}
    assert data_of("publish") == data_of("augment") | described
    models = {path.relative_to(ROOT).as_posix() for path in (ROOT / "rendering").rglob("*.yaml")}
    assert len(models) > 10
    assert data_of("render") == data_of("sample") | models
    assert {"data_raw/crowd/special_blocks.yaml", "pipelines/crowd/off_topic.yaml"} <= data_of("validate")


def test_only_rendering_depends_on_rendering():
    drawn = [stage for stage in STAGES if "rendering/rays/ray_casting.py" in files_of(f"hearth.pipelines.{stage}")]
    assert drawn == ["render"]


def test_the_digest_changes_with_whatever_is_imported(tmp_path, monkeypatch):
    package = tmp_path / "tools"
    package.mkdir()
    monkeypatch.setattr(dependencies, "ROOT", tmp_path)
    files = {
        "__init__.py": "",
        "one.py": "def f():\n    from hearth.tools import (\n        two,\n    )\n",
        "two.py": 'FILE = "words.yaml"\n',
        "three.py": "",
        "words.yaml": "a: 1",
    }
    for name, text in files.items():
        (package / name).write_text(text)

    def digest():
        for each in (dependencies._files, dependencies._read, code_digest):
            each.cache_clear()
        return code_digest("hearth.tools.one")

    try:
        first = digest()
        (package / "three.py").write_text("changed = True")
        assert digest() == first
        for name in ("two.py", "words.yaml", "one.py"):
            before = digest()
            (package / name).write_text(files[name] + "\n# changed")
            assert digest() != before, name
    finally:
        monkeypatch.undo()
        digest()
