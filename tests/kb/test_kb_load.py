"""Reading the files: what bad ones say, and what a user's own change."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

import hearth.kb
from hearth.kb.loading.load import FILES, load
from hearth.kb.tools.published_knowledge import read_release
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

OURS = Path(hearth.kb.__file__).parent / "data"
OBJECT_HEADER = "id,name,category,hypernym,properties,states,rooms,size,gloss,same_as,source\n"


def faults(folder, overlay=True):
    with pytest.raises(HearthError) as caught:
        load(overlay=folder) if overlay else load(folder)
    return caught.value.diagnostics


def lines(found):
    return [f"{Path(d.file).name}:{d.line}: {d.code}: {d.message}" for d in found]


def test_one_error_lists_every_fault_of_every_file(tmp_path):
    (tmp_path / "affordances.yaml").write_text("Cut: [{any: [CUTABLE]}]\nCut: [object]\nFly: [object]\n")
    (tmp_path / "aliases.csv").write_text("name,class,source\nloo,john,ours\njohn,loo,ours\nsettle,bensh,ours\n")
    (tmp_path / "placements.csv").write_text(
        "object,relation,destination,room,weight,evidence\n"
        "# a comment\n"
        "cup,ON,tabel,,3,ours\n"
        "cup,UPON,table,,3,ours\n"
        "cup,ON,bed,,9,ours\n"
        "cup,ON\n"
        "cup,ON,,,3,ours\n"
    )
    assert lines(faults(tmp_path)) == [
        "affordances.yaml:1: BAD_TABLE: `CUTABLE` is not a known property",
        "affordances.yaml:2: BAD_TABLE: `Cut` stands twice, first in line 1",
        "affordances.yaml:3: UNKNOWN_ACTION: `Fly` is not a known action",
        "aliases.csv:2: BAD_TABLE: `loo` is a synonym of itself in a circle",
        "aliases.csv:3: BAD_TABLE: `john` is a synonym of itself in a circle",
        "aliases.csv:4: UNKNOWN_OBJECT: `bensh` is not a known object",
        "placements.csv:3: UNKNOWN_OBJECT: `tabel` is not a known object",
        "placements.csv:4: BAD_TABLE: `UPON` is not a known relation",
        "placements.csv:5: BAD_TABLE: `9` is not a weight",
        "placements.csv:6: BAD_TABLE: 2 cells",
        "placements.csv:7: UNKNOWN_OBJECT: `` is not a known object",
    ]


def test_a_fault_says_the_remedy(tmp_path):
    (tmp_path / "affordances.yaml").write_text("Cut: [{any: [CUTABLE]}]\n")
    assert faults(tmp_path)[0].suggestion == "did you mean `CUTTABLE`?"


def test_faults_of_objects(tmp_path):
    (tmp_path / "objects_things.csv").write_text(
        OBJECT_HEADER
        + "9000,gadget,Props,device,GRABABLE,sleepy,kitchen,big,,,ours\n"
        + "9000,widget,Props,contraption,,,,,,,ours\n"
        + "x,thingy,Props,tool,,,,,,,ours\n"
        + "9001,this,Props,,,,,,,that,ours\n"
        + "9002,that,Props,,,,,,,this,ours\n"
        + "9003,other,Props,,,,,,,nobody,ours\n"
        + "9004,cup_,Props,tool,,,,,,,ours\n"
        + "9004,gadget,Props,tool,,,,,,,ours\n"
    )
    assert lines(faults(tmp_path)) == [
        "objects_things.csv:2: BAD_TABLE: `GRABABLE` is not a known property",
        "objects_things.csv:2: BAD_TABLE: `sleepy` is neither a state nor a group of states",
        "objects_things.csv:2: BAD_TABLE: `big` is not a size",
        "objects_things.csv:3: BAD_TABLE: `widget` has the id 9000 of `gadget`",
        "objects_things.csv:3: BAD_TABLE: `contraption` is neither a kind nor a class",
        "objects_things.csv:4: BAD_TABLE: `thingy` has no id",
        "objects_things.csv:5: BAD_TABLE: `this` is a synonym of itself in a circle",
        "objects_things.csv:6: BAD_TABLE: `that` is a synonym of itself in a circle",
        "objects_things.csv:7: UNKNOWN_OBJECT: `nobody` is not a known object",
        f"objects_things.csv:9: BAD_TABLE: `gadget` stands twice, first in {tmp_path}/objects_things.csv:2",
    ]


def test_a_name_that_may_mean_two_classes(tmp_path):
    (tmp_path / "objects_things.csv").write_text(OBJECT_HEADER + "9000,water_glas_s,Props,tool,,,,,,,ours\n")
    assert [d.message for d in faults(tmp_path)] == ["`water_glas_s` may mean `water_glass` or `water_glas_s`"]


def test_faults_of_actions(tmp_path):
    (tmp_path / "actions_written.yaml").write_text(
        "Fly: {id: 900, roles: [place], needs: [], flies: yes}\n"
        "Hop: {roles: [], needs: []}\n"
        "Jump: [up]\n"
        "Skip: {id: 901, roles: [thing], needs: [rope]}\n"
    )
    (tmp_path / "actions.yaml").write_text(
        "Wave:\n"
        "  id: 900\n"
        "  roles: [thing]\n"
        "  needs: [object]\n"
        "  before:\n"
        "  - NOT_NEAR: close(a, o)\n"
        "  - NOT_CLOSE: close(a, s)\n"
        "  - NOT_CLOSE: nearish(a, o)\n"
        "  - NOT_CLOSE: close(a o)\n"
        "  effects: [{like: Nothing}]\n"
    )
    assert [d.message for d in faults(tmp_path)] == [
        "`{'NOT_NEAR': 'close(a, o)'}` is not a check",
        "in `close(a o)`: expected ) but found `o`",
        "`{'like': 'Nothing'}` is not an effect",
        "`Wave` has the id 900 of `Fly`",
        "in `close(a, s)`: `s` is not an argument of Wave and is not bound",
        "in `nearish(a, o)`: nothing says what `nearish` is",
        "`flies` is not part of an action",
        "Fly has 1 roles but needs for 0",
        "Fly takes 1 objects, not 0",
        "`Hop` has no id",
        "`Jump` is not a mapping",
        "`rope` is not a requirement",
    ]


def test_faults_of_repairs_and_associations(tmp_path):
    (tmp_path / "repairs.yaml").write_text(
        "one: {on: NOT_CLOSE, actions: [Fly]}\ntwo: {on: SLEEPY}\nthree: {on: NOT_CLOSE, then: [Walk]}\n"
    )
    (tmp_path / "associations.csv").write_text(
        "name,relation,other,weight,evidence\npen,serves,Wright,3,ours\npen,likes,paper,3,ours\npenn,goes_with,paper,x,ours\n"
    )
    assert [d.message for d in faults(tmp_path)] == [
        "`Wright` is not a known action",
        "`likes` is not a known association",
        "`penn` is not a known object",
        "`x` is not a weight",
        "`Fly` is not a known action",
        "`SLEEPY` is not a failure code",
        "`then` is not part of a repair",
    ]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"Cut: [unclosed]]", "not YAML: "),
        (b"- a list", "not a mapping of names"),
        (b"Cut: \xff\xfe\x00", "byte 6 is not UTF-8 text"),
        (b"Cut: [object]\x00", "a NUL character"),
        (b"\t: x", "not YAML: "),
    ],
)
def test_what_is_no_yaml_is_one_fault_with_its_place(tmp_path, content, message):
    (tmp_path / "affordances.yaml").write_bytes(content)
    found = faults(tmp_path)
    assert len(found) == 1
    assert found[0].message.startswith(message)
    assert found[0].line == 1


def test_other_encodings_and_line_ends_are_read(tmp_path):
    text = "name,class,source\r\nthrone,toilet,ours\r\n"
    (tmp_path / "aliases.csv").write_bytes(text.encode("utf-16"))
    assert load(overlay=tmp_path).object_class("throne").name == "toilet"


def test_a_wrong_header_says_the_columns(tmp_path):
    (tmp_path / "aliases.csv").write_text("alias,class\nthrone,toilet\n")
    found = faults(tmp_path)
    assert found[0].message == "columns are alias,class"
    assert found[0].suggestion == "they are name,class,source"


def test_directories_that_are_none_or_hold_other_files(tmp_path):
    assert faults(tmp_path / "nowhere")[0].code == Code.MISSING_FILE
    (tmp_path / "objects_planes.csv").write_text("")
    assert "is not one of the knowledge's files" in faults(tmp_path)[0].message


def test_a_directory_of_its_own_must_be_complete(tmp_path):
    for name in FILES:
        if name != "rooms.yaml":
            shutil.copy(OURS / name, tmp_path)
    assert lines(faults(tmp_path, overlay=False)) == ["rooms.yaml:0: MISSING_FILE: is missing"]
    shutil.copy(OURS / "rooms.yaml", tmp_path)
    assert load(tmp_path).actions.keys() == load().actions.keys()


def test_an_overlay_adds_replaces_and_removes(tmp_path):
    (tmp_path / "objects_things.csv").write_text(
        OBJECT_HEADER
        + "9000,robot,Appliances,appliance,GRABBABLE HAS_SWITCH,,kitchen,0.3 0.1 0.3,cleans by itself,,mine\n"
        + "70,candle,Props,decoration,GRABBABLE,,living_room,0.1 0.1 0.1,a lamp of wax,,mine\n"
    )
    (tmp_path / "placements.csv").write_text(
        "object,relation,destination,room,weight,evidence\nrobot,ON,floor,,5,mine\nmilk,IN,trashcan,,0,mine\n"
    )
    (tmp_path / "aliases.csv").write_text("name,class,source\nhousehold_robot,robot,mine\n")
    (tmp_path / "limits.yaml").write_text("sit: {default: 1, couch: 9}\n")
    candle = load().objects["candle"].id
    text = (tmp_path / "objects_things.csv").read_text().replace("70,candle", f"{candle},candle")
    (tmp_path / "objects_things.csv").write_text(text)
    mine, ours = load(overlay=tmp_path), load()
    assert mine.affords("SwitchOn", 0, "household robot")
    assert mine.affords("SwitchOn", 0, "candle") is False
    assert ours.affords("SwitchOn", 0, "candle")
    assert [p.destination for p in mine.placements("robot")] == ["floor"]
    assert "trashcan" in {p.destination for p in ours.placements("milk")}
    assert "trashcan" not in {p.destination for p in mine.placements("milk")}
    assert (mine.seat_limit("couch"), mine.bed_limit("bed"), ours.seat_limit("couch")) == (9, 3, 4)
    assert len(mine.objects) == len(ours.objects) + 1


def test_the_files_are_sorted_and_say_what_they_are():
    for name in FILES:
        text = (OURS / name).read_text(encoding="utf-8")
        assert text.startswith("#"), name
        body = [line for line in text.splitlines() if line and not line.startswith("#")]
        if name.endswith(".csv"):
            keys = [line.split(",")[1 if name.startswith("objects_") else 0] for line in body[1:]]
            assert keys == sorted(keys), name
        elif name not in ("states.yaml", "repairs.yaml", "corrections.yaml"):
            keys = [line.split(":")[0] for line in body if line[0] not in " -}"]
            assert keys == sorted(keys) or name == "limits.yaml", name


@pytest.mark.parametrize(
    "text",
    [
        "a: &x [*x]\n",
        "a: " + "[" * 100_000,
        "- " * 100_000,
        "a0: &a0 [x, x]\n" + "".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 9)),
        "a: [" + "x," * 150_000 + "]\n",
        "# " + "x" * 5_000_000,
    ],
    ids=["itself", "deep", "deep block", "aliases", "wide", "long"],
)
def test_an_overlay_that_takes_too_much_to_read_is_refused(tmp_path, text):
    (tmp_path / "actions.yaml").write_text(text)
    (fault,) = faults(tmp_path)
    assert fault.code is Code.FILE_TOO_LARGE


def test_an_overlay_may_use_aliases(tmp_path):
    (tmp_path / "limits.yaml").write_text("sit: &seats {default: 3, sofa: 5}\nlie: *seats\n")
    known = load(overlay=tmp_path)
    assert (known.seat_limit("sofa"), known.bed_limit("sofa"), known.bed_limit("bed")) == (5, 5, 3)


def test_an_overlay_with_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "actions.yaml")
    with pytest.raises(HearthError, match="is not a regular file"):
        load(overlay=tmp_path)


@pytest.mark.parametrize("text", ["[" * 90_000, "7", '{"cup": [[]]}', '{"cup": 7}'])
def test_a_file_of_the_release_that_is_none_is_refused(tmp_path, text):
    (tmp_path / "object_states.json").write_text(text)
    with pytest.raises(HearthError, match="not the release's file"):
        read_release(tmp_path)


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("limits.yaml", "sit: 3", "`sit` is `3`"),
        ("limits.yaml", "lie: {bed: 3}", "`lie` is `{'bed': 3}`"),
        ("limits.yaml", "lie: {default: many}", "`lie` is `{'default': 'many'}`"),
        ("limits.yaml", "seat: {default: 1}", "`seat` is not an entry of limits.yaml"),
        ("rooms.yaml", "kitchen:", "`kitchen` is `None`"),
        ("rooms.yaml", "kitchen: {stand_in: [pantry]}", "`kitchen: stand_in` is `['pantry']`"),
        ("rooms.yaml", "kitchen: {stand_in: cup}", "`cup` is not a room that programs may name"),
        ("states.yaml", "power: [ON, OFF]", "`power` is `['ON', 'OFF']`"),
        ("tables.yaml", "table_like: desk", "`table_like` is `desk`"),
        (
            "tables.yaml",
            "default_states: {always: {states: [CLEAN]}, properties: {}}",
            "`default_states` lacks `classes`",
        ),
        ("tables.yaml", "tables_like: [desk]", "`tables_like` is not an entry of tables.yaml"),
        ("tables.yaml", "default_states: []", "`default_states` is `[]`"),
        (
            "tables.yaml",
            "default_states: {always: {}, class: {}, classes: {}, properties: {}}",
            "`class` is not a part of `default_states`",
        ),
        (
            "tables.yaml",
            "default_states: {always: {}, classes: {door: OPEN}, properties: {}}",
            "`default_states: classes` is `{'door': 'OPEN'}`",
        ),
        ("affordances.yaml", "Cut: 7", "`Cut` is `7`"),
        ("affordances.yaml", "Cut: [{any: {CUTTABLE: yes}}]", "`a requirement: any` is `{'CUTTABLE': 'yes'}`"),
        ("repairs.yaml", "one: {on: [IS_OPEN]}", "`one: on` is `['IS_OPEN']`"),
        ("actions_written.yaml", "Hop: {id: 900, roles: [], needs: yes}", "`Hop: needs` is `yes`"),
        ("actions.yaml", "Hop: {id: 900, effects: 5}", "`Hop: effects` is `5`"),
        ("actions.yaml", "Hop: {id: 900, effects: [{like: Hop}]}", "`Hop` is like itself in a circle"),
        ("actions.yaml", "Hop: {id: 900, effects: [{like: [Walk]}]}", "`{'like': ['Walk']}` is not an effect"),
        ("actions.yaml", f"Hop: {{id: {10**20}}}", "`Hop` has no id"),
        ("stand_ins.csv", f"class,rank,stand_in,source\ncup,{'1' * 5000},mug,ours", f"`{'1' * 5000}` is not a rank"),
        ("objects_things.csv", OBJECT_HEADER + f"{'1' * 5000},gadget,Props,tool,,,,,,,ours", "`gadget` has no id"),
        ("objects_things.csv", OBJECT_HEADER + "9000,gadget,Props,tool,,,,1 nan 2,,,ours", "`1 nan 2` is not a size"),
    ],
)
def test_entries_of_odd_shapes_are_faults_with_their_file_and_a_remedy(tmp_path, file, text, message):
    (tmp_path / file).write_text(text + "\n")
    first, *_ = faults(tmp_path)
    assert first.message == message
    assert first.file.endswith(file) and first.line > 0 and first.suggestion


@pytest.mark.parametrize(("whole", "given"), [("a", "b"), ("b", "a")])
def test_the_fault_of_an_overlay_comes_before_those_that_follow_from_it_wherever_the_folders_are(
    tmp_path, whole, given
):
    shutil.copytree(Path(hearth.kb.__file__).parent / "data", tmp_path / whole)
    (tmp_path / given).mkdir()
    (tmp_path / given / "states.yaml").write_text("power: [ON, OFF]\n")
    with pytest.raises(HearthError) as caught:
        load(tmp_path / whole, overlay=tmp_path / given)
    first, *others = caught.value.diagnostics
    assert first.message == "`power` is `['ON', 'OFF']`"
    assert {Path(each.file).name for each in others} == {"processes.yaml"}
