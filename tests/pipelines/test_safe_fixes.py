"""Safe corrections: only what can have been meant in one way is changed, and shown."""

import pytest
from typer.testing import CliRunner

from hearth.cli import app
from hearth.pipelines.checks.fixes import difference, fixed, only_near

HEAD = "Watch TV\nOn the sofa.\n\n\n"


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("[Wlak] <television> (1)", "[Walk] <television> (1)"),
        ("[Walk] <televison> (1)", "[Walk] <television> (1)"),
        ("  [Walk]  <television>", "  [Walk]  <television> (1)"),
        ("[Walk] <television> 2", "[Walk] <television> (2)"),
        ("[Special] <flush the toilet>", "[Touch] <toilet> (1)"),
        ("[Walk] <tv> (1)\n[SwitchOn] <tv> (1)\n[SwitchOn] <tv> (1)", "[Walk] <tv> (1)\n[SwitchOn] <tv> (1)"),
        ("[Walk] <bedroom> (1)\n[Sit] <sofa> (1)", "[Walk] <bedroom> (1)\n[Walk] <sofa> (1)\n[Sit] <sofa> (1)"),
    ],
)
def test_what_is_safe(knowledge, wrong, right):
    if wrong.startswith("[Special]"):
        wrong, right = f"[Walk] <toilet> (1)\n{wrong}", f"[Walk] <toilet> (1)\n{right}"
    assert fixed(f"{HEAD}{wrong}\n", knowledge) == f"{HEAD}{right}\n"


@pytest.mark.parametrize("line", ["[Fly] <television> (1)", "[Walk] <plat> (1)", "[Walk <bed> (1)", "[Special] <sing>"])
def test_what_is_not_safe_is_left(knowledge, line):
    assert fixed(f"{HEAD}{line}\n", knowledge) == f"{HEAD}{line}\n"


def test_the_nearest_must_be_alone(knowledge):
    assert only_near("televison", knowledge.object_spellings) == "television"
    assert only_near("plat", knowledge.object_spellings) is None


def test_the_command_shows_a_diff_and_changes_files_only_when_asked(tmp_path):
    file = tmp_path / "a.txt"
    text = f"{HEAD}[Walk] <televison> (1)\n"
    file.write_text(text)
    shown = CliRunner().invoke(app, ["check", "--diff", str(file)])
    assert (shown.exit_code, file.read_text()) == (1, text)
    assert "-[Walk] <televison> (1)\n+[Walk] <television> (1)\n" in shown.stdout
    done = CliRunner().invoke(app, ["check", "--fix", str(file)])
    assert (done.exit_code, file.read_text()) == (0, f"{HEAD}[Walk] <television> (1)\n")
    assert difference("a", "a", "x") == ""


def test_lint_warns_without_failing(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("Nap\nOn the sofa.\n\n\n[Walk] <bedroom> (1)\n[Sit] <sofa> (1)\n")
    result = CliRunner().invoke(app, ["check", "--lint", str(file)])
    assert result.exit_code == 0
    assert "warning[NOT_CLOSE]" in result.stdout and "write [Walk] <sofa> (1) before" in result.stdout


def test_lint_says_what_no_simulation_runs(tmp_path):
    file = tmp_path / "a.txt"
    file.write_text("Brush\n\n\n\n[Walk] <teeth> (1)\n[Brush] <teeth> (1)\n")
    result = CliRunner().invoke(app, ["check", "--lint", str(file)])
    assert result.exit_code == 0
    assert "warning[NOT_SIMULATED]: [Brush] can be written, but the simulator does not execute it" in result.stdout
    assert "a.txt:6:2" in result.stdout, "the action is underlined"
