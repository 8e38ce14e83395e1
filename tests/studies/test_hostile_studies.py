"""Folders of strangers: lists of films and collected events are checked before anything is done with them."""

import json
import shutil

import orjson
import pytest
from studies.small import simulated

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.studies.films_to_judge import JudgedFilm, read_films
from hearth.studies.study_folder import EVENTS, opened

FILM = JudgedFilm(0, "written", "000-a", "a", "Title: text", "rowan", 0.5, ["[Walk] <kitchen> (1)"]).as_json()


def films(tmp_path, value):
    path = tmp_path / "films.json"
    path.write_text(value if isinstance(value, str) else json.dumps(value))
    return read_films(path)


def refused(call, *given):
    with pytest.raises(HearthError) as caught:
        call(*given)
    return caught.value.diagnostics[0]


def test_films_are_read_as_they_were_written(tmp_path):
    (found,) = films(tmp_path, [FILM])
    assert found.as_json() == FILM


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "../../x"}, "`name` is not a number and a name"),
        ({"name": "000-a/../../x"}, "`name` is not a number and a name"),
        ({"item": -1}, "`item` is not a number of a task"),
        ({"item": True}, "`item` is not a number of a task"),
        ({"measure": float("inf")}, "not JSON"),
        ({"measure": "long"}, "`measure` is not a number"),
        ({"about": 7}, "`about` is not a text"),
        ({"content": [1]}, "`content` is not a program"),
        ({"content": {"task": "x"}}, "`content` is neither program nor episode"),
        ({"shell": "x"}, "it has other keys than a film"),
    ],
)
def test_a_film_with_a_fault_is_named(tmp_path, change, message):
    fault = refused(films, tmp_path, [FILM, {**FILM, "condition": "other", **change}])
    assert fault.code == Code.BAD_JSON
    assert message in fault.message
    assert fault.file == str(tmp_path / "films.json")


def test_what_is_no_list_of_films_is_refused(tmp_path):
    assert refused(films, tmp_path, {}).code == Code.BAD_JSON
    assert refused(films, tmp_path, "[" * 100_000).code == Code.BAD_JSON
    assert refused(films, tmp_path, [FILM, FILM]).code == Code.DUPLICATE
    assert refused(read_films, tmp_path / "none.json").code == Code.MISSING_FILE


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("made"))


@pytest.fixture
def changed(made, tmp_path):
    """Opens the simulated study with the first event of a kind changed."""

    def change(which, **values):
        folder = tmp_path / "small"
        shutil.copytree(made.folder, folder)
        lines = [orjson.loads(line) for line in (folder / EVENTS).read_bytes().splitlines()]
        line = next(each for each in lines[1:] if each["kind"] == which)
        line.update({name: value for name, value in values.items() if name in line})
        line["data"] = {**line["data"], **{name: value for name, value in values.items() if name not in line}}
        (folder / EVENTS).write_bytes(b"".join(orjson.dumps(each) + b"\n" for each in lines))
        return opened(folder, default)

    return change


def test_events_as_they_were_collected_are_opened(changed):
    assert len(changed("joined").ledger.streams()) == 5


@pytest.mark.parametrize(
    ("kind", "values", "message"),
    [
        ("joined", {"place": 4}, "there are 4 places"),
        ("joined", {"place": -1}, "there are 4 places"),
        ("joined", {"person": 7}, "`person` is 7"),
        ("did", {"item": 3_000}, "it is not the trial that comes there"),
        ("did", {"condition": "other"}, "it is not the trial that comes there"),
        ("did", {"record": {}}, "it has no record of its task"),
        ("did", {"seconds": "long"}, "`seconds` is long"),
        ("did", {"stream": "somebody"}, "is not the event that comes there"),
        ("did", {"kind": "danced"}, "`danced` does not happen there"),
        ("answered", {"answers": {"helpful": 8}}, "`helpful` is not an answer to a present question"),
        ("answered", {"answers": {"name": "Ann"}}, "`name` is not an answer to a present question"),
        ("finished", {"answers": {"comments": ["x"]}}, "`comments` is not an answer to a present question"),
        ("left", {"why": None}, "`why` is None"),
    ],
)
def test_an_event_of_another_study_is_named(changed, kind, values, message):
    fault = refused(lambda: changed(kind, **values))
    assert fault.code == Code.BAD_JSON
    assert message in fault.message


@pytest.mark.parametrize("line", [0, 1])
def test_values_too_deep_in_one_another(made, tmp_path, line):
    folder = shutil.copytree(made.folder, tmp_path / "deep")
    lines = [json.loads(each) for each in (folder / EVENTS).read_text().splitlines()]
    (lines[0] if line == 0 else lines[1]["data"])["deep"] = "DEEP"
    text = "".join(json.dumps(each, separators=(",", ":")) + "\n" for each in lines)
    (folder / EVENTS).write_text(text.replace('"DEEP"', "[" * 300 + "]" * 300))
    assert refused(opened, folder, default).code == Code.BAD_JSON
