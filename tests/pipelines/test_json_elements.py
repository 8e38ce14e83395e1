"""JSON lists read entry by entry give what reading them whole gives, however the text is cut into pieces."""

import json

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from hearth.pipelines.readers import json_elements, reader_items
from hearth.schemas.failures import Code
from hearth.storage.rejects import Reject

TEXT = st.text('ab"\\[]{},: \né', max_size=5)
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | TEXT,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(TEXT, inner, max_size=3),
    max_leaves=8,
)


@pytest.fixture
def cut(monkeypatch):
    return lambda size: monkeypatch.setattr(reader_items, "_PIECE", size)


def values(path, key=""):
    return [value for _, value in json_elements.entries(path, "f", key)]


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(VALUES, max_size=5), st.sampled_from([None, 1]), st.sampled_from([1, 2, 3, 7, 1 << 18]))
def test_a_list(tmp_path, cut, listed, indent, size):
    cut(size)
    file = tmp_path / "a.json"
    file.write_text(json.dumps(listed, indent=indent, ensure_ascii=size % 2 == 0) + "\n")
    assert values(file) == listed


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(VALUES, st.lists(VALUES, max_size=3), st.permutations(["a", "answer", "b"]), st.sampled_from([1, 3, 1 << 18]))
def test_a_list_under_a_key(tmp_path, cut, other, listed, order, size):
    cut(size)
    whole = {"a": other, "answer": listed, "b": {"answer": [1]}}
    file = tmp_path / "a.json"
    file.write_text(json.dumps({key: whole[key] for key in order}))
    assert values(file, "answer") == listed
    marks = {list: "[", dict: "{", str: '"'}
    assert json_elements.kinds(file) == {
        k: marks[type(v)] for k, v in whole.items() if isinstance(v, list | dict | str)
    }


@pytest.mark.parametrize(
    ("text", "good", "line"),
    [("[1,2", [1], 1), ("[1,,2]", [1, 2], 1), ("[,]", [], 1), ("[1] x", [1], 1), ("x[1]", [], 1), ("[1}", [1], 1),
     ('["a', [], 1), ("\n\n[1,\n\nx]", [1], 5)],
)  # fmt: skip
def test_a_broken_document_is_reported_once_with_its_line(tmp_path, text, good, line):
    file = tmp_path / "a.json"
    file.write_text(text)
    found = values(file)
    (fault,) = (value.diagnostics[0] for value in found if isinstance(value, Reject))
    assert [value for value in found if not isinstance(value, Reject)] == good
    assert (fault.code, fault.line) == (Code.BAD_JSON, line)


@pytest.mark.parametrize("size", [1, 3, 1 << 18])
def test_comments_and_a_last_comma_mean_nothing(tmp_path, cut, size):
    cut(size)
    file = tmp_path / "a.json"
    file.write_text('// it\'s "mine" [\n[1, // one {\n /* two\n ] */ {"a": "// no comment", "b": [2,],},\n] // end')
    assert values(file) == [1, {"a": "// no comment", "b": [2]}]


def test_an_entry_without_end_is_refused_and_not_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(json_elements, "LONGEST_ENTRY", 1_000)
    file = tmp_path / "a.json"
    file.write_text(json.dumps(["short", "x" * 2_000_000, "after"]))
    short, refusal = values(file)
    assert short == "short" and refusal.diagnostics[0].code is Code.FILE_TOO_LARGE
