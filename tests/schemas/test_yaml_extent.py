"""YAML that stands for more than it takes to write is refused at once, wherever people's YAML is read."""

from __future__ import annotations

import time

import pytest
import yaml

from hearth.analysis import synthesis
from hearth.homes import library
from hearth.repair.perturbation_strengths import load_strengths
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.yaml_limits import DEEPEST, LARGEST, MOST, too_much

LAUGHS = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"a{number}: &a{number} [{', '.join([f'*a{number - 1}'] * 9)}]\n" for number in range(1, 9)
)
BOMBS = {
    "aliases": LAUGHS,
    "merged": "a0: &a0 {x: 1}\n" + "".join(f"a{n}: &a{n} {{k: *a{n - 1}, l: *a{n - 1}}}\n" for n in range(1, 40)),
    "itself": "a: &a [*a, *a]\n",
    "deep": "a: " + "[" * 5_000 + "]" * 5_000,
    "deep keys": "".join("  " * n + "a:\n" for n in range(500)),
    "open": "a: " + "[" * 100_000,
    "many": "a: [" + "x, " * (MOST + 1) + "]",
    "keys of keys": "? " * 3_000 + "a",
}


@pytest.mark.parametrize("name", BOMBS)
def test_what_people_give_as_yaml_is_refused_before_it_is_built(tmp_path, knowledge, name):
    path = tmp_path / "home.yaml"
    path.write_text(BOMBS[name])
    readers = (
        lambda: library.layout_of(path, knowledge),
        lambda: load_strengths(path),
        lambda: synthesis.load(path, knowledge),
    )
    started = time.perf_counter()
    for read in readers:
        with pytest.raises(HearthError) as error:
            read()
        assert error.value.diagnostics[0].code in (Code.FILE_TOO_LARGE, Code.SYNTAX, Code.BAD_TABLE)
    assert time.perf_counter() - started < 10


def test_the_limits_are_these():
    deep = "[" * (DEEPEST - 1) + "]" * (DEEPEST - 1)
    assert too_much(deep) == "" and too_much(f"[{deep}]")
    wide = f"[{', '.join(['1'] * (MOST - 1))}]"
    assert too_much(wide) == "" and too_much(f"[{wide}, 1]")
    assert too_much("#" * (LARGEST + 1)) and too_much("#" * LARGEST) == ""
    assert too_much("a: &a [1, 2]\nb: [*a, *a]") == "" and too_much("}") == ""
    assert yaml.safe_load(deep)
