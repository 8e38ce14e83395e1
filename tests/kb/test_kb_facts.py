"""Facts of the knowledge: the grammar, the objects, their states and places, as thesis and release have them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from hearth.kb.spelling import key_of, near_names
from hearth.schemas.failures import Code
from hearth.schemas.vocabulary import OPPOSITE, PROPERTIES, STATES
from hearth.simulation.actions.registry import ACTIONS

IDS = Path(__file__).resolve().parents[1] / "golden/kb/ids.json"

TABLE_2_2 = """
Walk Run Walktowards Walkforward Turnleft Turnright Sit StandUp Grab Open Close PutBack PutIn SwitchOn SwitchOff Drink
Touch LookAt
"""
TABLES_B1_C2 = """
plate fork waterglass wineglass cupcake pancake poundcake pudding salmon apple juice wine coffeepot remote condiment
chips dinnertable kitchentable coffeetable dishwasher fridge stove sofa book
"""
TABLE_A2 = {
    "ON OFF", "PLUGGED_IN PLUGGED_OUT", "OPEN CLOSED", "FREE OCCUPIED", "DIRTY CLEAN", "FULL EMPTY",
    "GRABBED", "FLUSHED",
    "SHARPENED", "WET DRY", "PEELED SLICED SQUEEZED", "BURNING", "FROZEN", "FOLDED UNFOLDED", "HOT COLD",
    "COOKED RAW ROTTEN",
}  # fmt: skip
TABLE_A3 = """
wine_glass IN cupboard cabinet dishwasher ON coffee_table dishrack kitchen_counter
milk IN fridge microwave trashcan sauce_pan ON kitchen_counter table pantry
remote_control IN dresser ON couch love_seat bed table mousepad NEARBY dvd_player
pot IN microwave cupboard cabinet ON dishrack kitchen_counter stove
razor IN cabinet trashcan bag box ON table bathroom_counter
cd_player IN closet cabinet bag ON table couch NEARBY stereo
food_chicken IN fridge trashcan freezer sauce_pan oven ON kitchen_counter cutting_board plate
oven_mitts IN oven cabinet basket_for_clothes ON table kitchen_counter
document IN folder trashcan cabinet filing_cabinet ON desk couch bookshelf music_stand
sheets IN basket_for_clothes dresser washing_machine cabinet ON couch love_seat bed
"""


def test_the_grammar_has_84_actions_of_which_42_are_executed(knowledge):
    published = [action for action in knowledge.actions.values() if action.id < 84]
    assert len(published) == 84
    assert sum(action.executed for action in published) == 42
    assert {name for name, action in knowledge.actions.items() if action.executed} == ACTIONS.keys()
    assert all(knowledge.actions[name] for name in TABLE_2_2.split())
    arities = {action.name: action.arity for action in knowledge.actions.values()}
    assert [arities[name] for name in ("StandUp", "Grab", "PutBack", "Pour", "Throw", "Turnleft")] == [0, 1, 2, 2, 2, 0]


def test_published_ids_never_change(knowledge):
    """Append only: refresh with `python -m json.tool` of the ids when classes or actions were added."""
    golden = json.loads(IDS.read_text())
    actions = {name: action.id for name, action in knowledge.actions.items()}
    objects = {name: thing.id for name, thing in knowledge.objects.items()}
    assert {name: actions.get(name) for name in golden["actions"]} == golden["actions"]
    assert {name: objects.get(name) for name in golden["objects"]} == golden["objects"]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("put back", "PutBack"), ("PUTBACK", "PutBack"), ("Putin", "PutIn"), ("switch_on", "SwitchOn"),
        ("turn to", "TurnTo"),
        ("Standup", "StandUp"), ("STANDUP", "StandUp"), ("put", "PutBack"), ("unplug", "PlugOut"),
        ("walk towards", "Walktowards"),
        ("turn on", "SwitchOn"), ("PutObjBack", "PutObjBack"),
    ],
)  # fmt: skip
def test_actions_are_known_by_any_spelling(knowledge, text, name):
    assert knowledge.action(text).name == name


def test_unknown_names_are_none_and_get_suggestions(knowledge):
    assert knowledge.action("Fly") is None
    assert knowledge.object_class("televison") is None
    assert knowledge.suggest("televison")[0] == "television"
    assert knowledge.suggest("Swichon", "action")[0] == "SwitchOn"
    assert knowledge.suggest("xqzzw") == ()


@pytest.mark.parametrize(
    ("kind", "name", "near"),
    [
        ("action", "Wlak", ("WakeUp", "Walk")), ("action", "Listen", ()), ("action", "Use", ()),
        ("action", "PutBak", ("PutBack", "PutObjBack")), ("object", "televison", ("television",)),
        ("object", "garden_table", ("table",)), ("object", "laptop computer", ("computer", "laptop")),
        ("object", "remote", ("remote_control",)), ("object", "tv", ()), ("object", "s", ()), ("object", "", ()),
    ],
)  # fmt: skip
def test_names_are_suggested_that_are_alike_or_of_the_same_words(knowledge, kind, name, near):
    spellings = knowledge.action_spellings if kind == "action" else knowledge.object_spellings
    assert near_names(name, {key: known for key, known in spellings.items() if key != "tv"}) == near


@pytest.mark.parametrize(
    ("action", "position", "properties", "name", "accepted"),
    [
        ("Open", 0, {"CAN_OPEN"}, "box", True), ("Open", 0, set(), "desk", True), ("Open", 0, set(), "window", True),
        ("Open", 0, {"GRABBABLE"}, "cup", False), ("Grab", 0, {"GRABBABLE"}, "cup", True), ("Grab", 0,
        set(), "water", True),
        ("Grab", 0, set(), "child", True), ("Grab", 0, set(), "man", False), ("Push", 0, set(), "wall", True),
        ("Pull", 0, set(), "wall", False), ("Pull", 0, set(), "curtain", True), ("Move", 0, {"MOVABLE"}, "table", True),
        ("Pour", 1, {"RECIPIENT"}, "pot", True), ("Pour", 1, set(), "face", True), ("Pour", 1, set(), "table", False),
        ("Cut", 0, {"EATABLE"}, "soup", False), ("Cut", 0, {"EATABLE", "CUTTABLE"}, "apple", True),
        ("Squeeze", 0, set(), "food_lemon", True), ("Squeeze", 0, set(), "lamp", False), ("Type", 0, set(),
        "keyboard", True),
        ("Drink", 0, {"RECIPIENT"}, "cup", True), ("Walk", 0, set(), "kitchen", True),
    ],
)  # fmt: skip
def test_what_execution_needs_of_an_object(knowledge, action, position, properties, name, accepted):
    assert knowledge.actions[action].needs[position].accepts(frozenset(properties), name) is accepted


def test_the_grammar_refuses_rooms_where_objects_are_meant(knowledge):
    assert knowledge.affords("Walk", 0, "living room")
    assert not knowledge.affords("Touch", 0, "living room")
    assert not knowledge.affords("Fly", 0, "cup")
    assert not knowledge.affords("Open", 1, "fridge")
    assert not knowledge.affords("Open", 0, "flux capacitor")


def test_there_are_enough_classes_and_each_is_complete(knowledge):
    assert len(knowledge.objects) >= 390
    for thing in knowledge.objects.values():
        assert thing.gloss and thing.category and all(edge > 0 for edge in thing.size), thing.name
        assert thing.properties <= set(PROPERTIES)
        assert knowledge.ancestors(thing.name)[-1] == "thing", thing.name
    glosses = [thing.gloss for thing in knowledge.objects.values() if not thing.same_as]
    assert len(set(glosses)) == len(glosses)


@pytest.mark.parametrize("name", TABLES_B1_C2.split())
def test_the_goals_objects_are_known(knowledge, name):
    assert knowledge.object_class(name) is not None


def test_synonyms_work_both_ways(knowledge):
    assert knowledge.object_class("sofa").same_as == "couch"
    assert knowledge.objects["sofa"].properties == knowledge.objects["couch"].properties
    assert knowledge.same_class("couch")[:2] == ("couch", "sofa")
    assert knowledge.same_class("sofa")[:2] == ("sofa", "couch")
    assert knowledge.object_class("TV").name == "television"
    assert "tv" in knowledge.objects["television"].synonyms
    assert knowledge.object_class("Water Glass") is knowledge.object_class("waterglass")
    assert knowledge.same_class("food_snack")[0] == "food_snack"
    assert {"mug", "waterglass"} <= set(knowledge.same_class("cup"))
    assert knowledge.same_class("flux_capacitor") == ("flux_capacitor",)
    assert knowledge.placements("sofa") == knowledge.placements("couch")


def test_every_spelling_resolves(knowledge):
    for name, thing in knowledge.objects.items():
        for spelling in (name, name.upper(), name.replace("_", " ").title(), key_of(name), *thing.synonyms):
            found = knowledge.object_class(spelling)
            assert (found.same_as or found.name) == (thing.same_as or name), spelling


def test_the_states_of_table_a2(knowledge):
    in_table = {state for group in knowledge.state_groups.values() for state in group.table}
    assert in_table == {state for row in TABLE_A2 for state in row.split()}
    assert len(in_table) == 29
    simulated = {state for group in knowledge.state_groups.values() if group.simulated for state in group.states}
    assert len(simulated) == 10
    assert simulated - {"FREE", "OCCUPIED"} == set(STATES) - {"SITTING", "LYING"}


def test_simulated_states_exclude_their_opposites(knowledge):
    for state in STATES[:8]:
        assert knowledge.excludes(state) == (OPPOSITE[state],)
    assert knowledge.excludes("PEELED") == ()
    assert set(knowledge.excludes("RAW")) == {"COOKED", "ROTTEN", "BURNT"}


@pytest.mark.parametrize("row", TABLE_A3.split("\n")[1:-1])
def test_the_rows_of_table_a3_hold(knowledge, row):
    name, *rest = row.split()
    held = {(p.relation, p.destination) for p in knowledge.placements(name)}
    relation = ""
    for word in rest:
        if word in ("IN", "ON", "NEARBY"):
            relation = word
        else:
            assert (relation, word) in held, (name, relation, word)


def test_there_are_enough_placements_with_weight_and_evidence(knowledge):
    rows = {p for name in knowledge.objects for p in knowledge.placements(name)}
    assert len({row[:3] for row in rows}) >= 1900
    assert {row.weight for row in rows} == {1, 2, 3, 4, 5}
    assert {word for row in rows for word in row.evidence.split()} == {"release", "thesis", "homes", "ours"}
    assert {p.edge for p in rows} == {"ON", "INSIDE", "CLOSE"}


def test_places_say_what_they_hold_most_usual_first(knowledge):
    weights = [p.weight for p in knowledge.holds("fridge")]
    assert weights == sorted(weights, reverse=True)
    assert "milk" in {p.object for p in knowledge.holds("refrigerator") if p.weight == 5}
    assert knowledge.placements("nowhere") == ()


def test_limits_rooms_and_defaults(knowledge):
    assert [knowledge.seat_limit(name) for name in ("couch", "sofa", "bench", "chair", "stove")] == [4, 4, 2, 1, 1]
    assert [knowledge.seat_limit(name) for name in ("love_seat", "loveseat", "settee", "pianobench")] == [2, 2, 4, 2]
    assert [knowledge.bed_limit(name) for name in ("bed", "bathtub", "bench", "mat")] == [3, 2, 1, 1]
    assert knowledge.has("sofa", "SITTABLE") and knowledge.has("bed", "LIEABLE")
    assert not knowledge.has("table", "SITTABLE")
    assert len(knowledge.rooms) == 8 and knowledge.is_room("Home Office") and not knowledge.is_room("bed")
    assert knowledge.stand_ins("kitchen") == ("dining_room",) and knowledge.stand_ins("dining_room") == ("kitchen",)
    assert knowledge.stand_ins("entrance_hall") == ("living_room", "home_office")
    assert knowledge.default_states("fridge") == ("CLEAN", "CLOSED", "OFF", "PLUGGED_IN")
    assert knowledge.default_states("floor_lamp") == ("CLEAN", "ON")
    assert knowledge.default_states("door") == ("CLEAN", "OPEN")
    assert knowledge.default_states("nothing") == ()
    assert "bookshelf" in knowledge.table_like and "fridge" not in knowledge.table_like


def test_what_achieves_a_predicate(knowledge):
    def names(predicate):
        return {action.name for action, _ in knowledge.achievers(predicate)}

    assert names("OPEN") == {"Open"}
    assert names("ON") == {"SwitchOn", "PutBack", "PutObjBack", "PutOn", "Sit", "Lie"}
    assert names("HOLDS_RH") == {"Grab"}
    assert names("CLEAN") == {"Wash", "Wipe", "Rinse", "Scrub"}
    assert {"Walk", "Run", "Find", "Grab"} <= names("CLOSE")
    assert names("FLYING") == set()


def test_the_repairs_of_table_a4(knowledge):
    a4 = [repair for repair in knowledge.repairs.values() if repair.source == "A.4"]
    assert {repair.code for repair in a4} == {
        Code.IS_OPEN, Code.IS_CLOSED, Code.NOT_SITTING_OR_LYING, Code.SITTING, Code.NOT_CLOSE,
        Code.NOT_FACING, Code.IS_ON,
        Code.IS_OFF, Code.IS_PLUGGED, Code.IS_UNPLUGGED, Code.OCCUPIED, Code.INSIDE_CLOSED, Code.NO_FREE_HAND,
    }  # fmt: skip
    assert [r.name for r in knowledge.repairs_for(Code.IS_ON, "Open")] == ["on_to_open"]
    assert [r.name for r in knowledge.repairs_for(Code.SITTING, "Sit")] == ["sitting_to_sit", "sitting_to_walk"]
    assert knowledge.repairs_for(Code.NOT_AFFORDED, "Open") == ()


def test_every_failure_of_a_check_that_can_be_mended_has_a_repair(knowledge):
    hopeless = {
        Code.NOT_AFFORDED,
        Code.NO_ROOM,
        Code.NO_ORIGIN,
        Code.NOT_OPENABLE_STATE,
        Code.NOT_WORN,
        Code.NOTHING_TO_EAT,
    }
    for action in knowledge.actions.values():
        for check in action.preconditions:
            assert check.code in hopeless or knowledge.repairs_for(check.code, action.name), (action.name, check.code)


def test_repairs_and_handlers_are_for_the_same_failures(knowledge):
    from hearth.repair.handlers.registry import HANDLERS

    assert {repair.code for repair in knowledge.repairs.values()} == set(HANDLERS)
