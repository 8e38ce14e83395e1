"""Knowledge of strangers: files that stand for more than they hold, that wait, or whose words are more than words."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path

import pytest

import hearth.kb
from hearth.datasets.export.pddl_domain import planning_domain
from hearth.kb.loading.load import FILES, load
from hearth.kb.tools.compare import compare
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

OURS = Path(hearth.kb.__file__).parent / "data"
BOMB = "a0: &a0 [x, x]\n" + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 60))
OPEN = (
    "Open: {{id: 27, roles: [container], needs: [object], before: [{{NOT_CLOSE: '{before}'}}], say: '{say}'{more}}}\n"
)


def refused(call):
    with pytest.raises(HearthError) as caught:
        call()
    return caught.value.diagnostics


def laid(tmp_path, **texts):
    for name, text in texts.items():
        (tmp_path / f"{name}.yaml").write_text(text)
    return load(overlay=tmp_path)


@pytest.mark.parametrize("name", [name for name in FILES if name.endswith(".yaml") and name != "corrections.yaml"])
def test_a_character_that_yaml_does_not_allow(tmp_path, name):
    (tmp_path / name).write_text('a: "\x07"\n')
    assert refused(lambda: load(overlay=tmp_path))[0].code == Code.BAD_TABLE


@pytest.mark.parametrize("kind", ["bomb", "pipe", "device"])
def test_a_whole_directory_of_others_has_limits_too(tmp_path, knowledge, kind):
    folder = shutil.copytree(OURS, tmp_path / "theirs")
    file = folder / "rooms.yaml"
    file.unlink()
    if kind == "bomb":
        file.write_text(BOMB)
    elif kind == "pipe":
        os.mkfifo(file)
    else:
        file.symlink_to("/dev/zero")
    assert refused(lambda: compare(knowledge, folder))[0].code in (Code.FILE_TOO_LARGE, Code.UNSUPPORTED_FILE)


@pytest.mark.parametrize("facts", [{"cup": [1]}, {"cup": [None, "x"]}, {"cup": "ab", "cap": [1]}])
def test_facts_of_the_release_are_texts(tmp_path, knowledge, facts):
    (tmp_path / "object_states.json").write_text(json.dumps(facts))
    assert refused(lambda: compare(knowledge, tmp_path))[0].code == Code.BAD_JSON


def test_a_file_of_facts_that_has_no_end(tmp_path, knowledge):
    with (tmp_path / "object_states.json").open("wb") as file:
        file.truncate(6 << 30)
    assert refused(lambda: compare(knowledge, tmp_path))[0].code == Code.FILE_TOO_LARGE


SAID = ["Open {0.__class__}", "Open {0:>3000000000}", "Open {9}", "Open {", "Open {0} {0}", "Open {}", "Open {0!r}"]


@pytest.mark.parametrize("say", SAID)
def test_phrases_have_no_more_than_places_for_objects(tmp_path, say):
    (fault,) = refused(lambda: laid(tmp_path, actions=OPEN.format(before="close(a, o)", say=say, more="")))
    assert "`say` of Open" in fault.message and fault.suggestion == "words with {0}, each once"


def test_words_have_no_places(tmp_path):
    text = OPEN.format(before="close(a, o)", say="Open {0}", more=", words: ['pull {1}{1}{1}{1}']")
    assert "words of Open" in refused(lambda: laid(tmp_path, actions=text))[0].message


def test_actions_that_are_twice_like_each_other(tmp_path):
    first = "Aa0: {id: 900, roles: [x], needs: [object], effects: ['state(o, OPEN)'], say: 'Do {0}'}\n"
    more = "".join(
        f"Aa{n}: {{id: {900 + n}, roles: [x], needs: [object], effects: [{{like: Aa{n - 1}}}, {{like: Aa{n - 1}}}], "
        "say: 'Do {0}'}\n"
        for n in range(1, 40)
    )
    assert "more than 1,000 effects" in refused(lambda: laid(tmp_path, actions=first + more))[0].message


DEFINED = {
    "dx(a, x): dy(a, x)\ndy(a, x): dx(a, x)\n": "follows from itself",
    "".join(f"d{n}(a, x): d{n - 1}(a, x) & d{n - 1}(a, x)\n" for n in range(1, 40)) + "d0(a, x): ON(a, x)\n":
        "stands for more than 10,000 predicates",
    "close(a): ON(a, a)\n": "has 2 terms, not 1",
    "close(a, x): ON(a, zz)\n": "`zz` is not an argument",
    "close(a, x): FOO(a, x)\n": "nothing says what `FOO` is",
    "close(a, x): ON(a)\n": "has 1 terms, not 2",
    "close(a, a): ON(a, a)\n": "other terms than different variables",
    "close(a, x): affords(x)\n": "depends on an action",
    'close(a, x): "count y: ON(y, x) < foo(x)"\n': "`foo` is not a number",
}  # fmt: skip


@pytest.mark.parametrize("text", DEFINED)
def test_definitions_that_cannot_be_used(tmp_path, text):
    assert any(DEFINED[text] in fault.message for fault in refused(lambda: laid(tmp_path, derived=text)))


def test_limits_that_planners_can_write_out(tmp_path):
    assert refused(lambda: laid(tmp_path, limits="sit: {default: 1000000000}\n"))[0].code == Code.BAD_TABLE


def test_what_is_allowed_is_written_out(tmp_path):
    known = laid(tmp_path, derived="mine(a, x): close(a, x) & not ON(a, x)\n",
                 actions=OPEN.format(before="mine(a, o)", say="Open {0}", more=""))  # fmt: skip
    assert "(:action Open" in planning_domain(known)
