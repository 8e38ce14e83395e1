"""Looking things up: sheets, searches, chains, views, phrases, and other forms."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path

import pytest

from hearth.kb.language.step_phrases import parses, say
from hearth.kb.tools import graph_and_tables
from hearth.kb.tools.action_table import action_table
from hearth.kb.tools.export import export
from hearth.kb.tools.find import Query, find
from hearth.kb.tools.pddl import domain
from hearth.kb.tools.relation_paths import path
from hearth.kb.tools.show import about_action, about_object
from hearth.schemas.diagnostics import HearthError

GOLDEN = Path(__file__).resolve().parents[1] / "golden/kb"


def test_a_sheet_says_everything_of_an_object(knowledge):
    sheet = about_object(knowledge, knowledge.objects["spectacles"])
    assert sheet["kind"][0] == "accessory"
    assert {"relation": "goes_with", "other": "book", "weight": 5, "evidence": "ours"} in sheet["goes_with"]
    assert "Grab" in sheet["takes_it_first"]
    assert "glasses" in sheet["synonyms"]


def test_a_sheet_says_which_affordances_are_our_own(knowledge):
    own = {
        row["action"]: row["evidence"] for row in about_object(knowledge, knowledge.objects["food_donut"])["our_own"]
    }
    assert own["Eat"].startswith("ours: follows from EATABLE")
    assert "Grab" not in own


def test_a_sheet_says_everything_of_an_action(knowledge):
    sheet = about_action(knowledge, knowledge.actions["Open"])
    assert [row["else"] for row in sheet["before"]][:2] == ["NOT_AFFORDED", "NOT_CLOSE"]
    assert {row["on"] for row in sheet["repairs"]} == {
        "NOT_CLOSE",
        "NO_FREE_HAND",
        "IS_OPEN",
        "NOT_OPENABLE_STATE",
        "IS_ON",
    }
    assert about_action(knowledge, knowledge.actions["Read"])["served_by"][0] == "bookmark"


def test_searches_meet_every_condition(knowledge):
    found = find(knowledge, Query(can=("Grab", "drink"), inside="fridge"))
    assert found[0].name == "juice"
    for thing in found:
        assert knowledge.affords("Grab", 0, thing.name) and knowledge.affords("Drink", 0, thing.name)
        assert "fridge" in {p.destination for p in knowledge.placements(thing.name) if p.relation == "IN"}
    seats = {thing.name for thing in find(knowledge, Query(kind="seat", room="kitchen", has=("sittable",)))}
    assert {"chair", "stool"} <= seats and "couch" not in seats
    assert {thing.name for thing in find(knowledge, Query(may_be=("sharpened",)))} == {"chef_knife", "knife"}
    assert "sofa" in {thing.name for thing in find(knowledge, Query(on="floor"))}


def test_a_search_lists_every_unknown_name(knowledge):
    with pytest.raises(HearthError) as caught:
        find(knowledge, Query(can=("Grb",), inside="frige", has=("GRABABLE",), kind="fruits", may_be=("odd",)))
    assert [d.found for d in caught.value.diagnostics] == ["Grb", "frige", "GRABABLE", "odd", "fruits"]
    assert "`fridge`" in caught.value.diagnostics[1].suggestion


@pytest.mark.parametrize(
    ("first", "second", "chain"),
    [
        ("spectacles", "book", ["spectacles -goes_with-> book"]),
        ("book", "glasses", ["book <-goes_with- spectacles"]),
        ("nightstand", "bed", ["nightstand -NEARBY-> bed"]),
        ("spectacles", "Read", ["spectacles -serves-> action:Read"]),
        ("fridge", "appliance", ["fridge -is_a-> kind:appliance"]),
        ("bed", "bed", []),
    ],
)
def test_how_two_things_are_related(knowledge, first, second, chain):
    assert [str(link) for link in path(knowledge, first, second)] == chain


def test_a_chain_joins_and_an_unknown_name_is_named(knowledge):
    links = path(knowledge, "fork", "lamp")
    assert links[0].source == "fork" and links[-1].target == "lamp"
    assert all(before.target == after.source for before, after in pairwise(links))
    with pytest.raises(KeyError, match="frok"):
        path(knowledge, "frok", "lamp")


def test_the_graph_holds_what_the_tables_hold(knowledge):
    graph = graph_and_tables.graph(knowledge)
    tables = graph_and_tables.tables(knowledge)
    relations = [data["relation"] for _, _, data in graph.edges(data=True)]
    assert sum(relation in ("ON", "IN", "NEARBY") for relation in relations) == len(tables["placements"])
    assert sum(relation.startswith("takes_") for relation in relations) == len(tables["affordances"])
    assert graph.nodes["fridge"]["type"] == "class" and graph.nodes["kitchen"]["type"] == "room"
    assert graph.has_edge("milk", "fridge") and graph.has_edge("fridge", "kind:appliance")
    assert all("evidence" in data for _, _, data in graph.edges(data=True) if data["relation"].startswith("takes_"))


def test_the_database_answers(knowledge):
    with graph_and_tables.connect(knowledge) as database:
        sql = "SELECT count(*) FROM actions WHERE executed"
        assert database.execute(sql).fetchone() == (sum(action.executed for action in knowledge.actions.values()),)
        sql = """
            SELECT DISTINCT p.object FROM placements p JOIN affordances a ON a.class = p.object AND a.action = 'Drink'
            WHERE p.destination = 'fridge' AND p.relation = 'IN' AND p.weight = 5 ORDER BY 1
        """
        assert [row[0] for row in database.execute(sql).fetchall()] == ["juice", "milk"]
        names = {row[0] for row in database.execute("SELECT table_name FROM duckdb_tables()").fetchall()}
    assert names == set(graph_and_tables.tables(knowledge))


def test_steps_are_phrases_that_parse(knowledge):
    for action in knowledge.actions.values():
        names = ("coffee_cup", "kitchen_table")[: action.arity]
        said = say(action, names)
        assert (action, names) in parses(knowledge, said), said


@pytest.mark.parametrize(
    ("text", "action", "names"),
    [
        ("Put back soap", "PutObjBack", ("soap",)),
        ("Put soap on washing machine", "PutBack", ("soap", "washing_machine")),
        ("Put shoes in dresser", "PutIn", ("shoes", "dresser")),
        ("Put on headset", "PutOn", ("headset",)),
        ("Take off shoes", "PutOff", ("shoes",)),
        ("go to the kitchen.", "Walk", ("kitchen",)),
        ("Pick up the TV", "Grab", ("television",)),
        ("turn on light", "SwitchOn", ("light",)),
        ("Turn to computer", "TurnTo", ("computer",)),
        ("Pour milk into coffee cup", "Pour", ("milk", "coffee_cup")),
        ("Sleep", "Sleep", ()),
        ("Walk to flux capacitor", "Walk", ("flux_capacitor",)),
    ],
)
def test_sentences_are_parsed(knowledge, text, action, names):
    found = parses(knowledge, text)
    assert (found[0][0].name, found[0][1]) == (action, names)


def test_a_sentence_without_meaning_has_no_parse(knowledge):
    assert parses(knowledge, "quickly") == ()


def test_the_domain_is_well_formed(knowledge):
    text = domain(knowledge)
    assert text.count("(") == text.count(")")
    assert len(re.findall(r"\(:action (\w+)", text)) == sum(action.executed for action in knowledge.actions.values())
    declared = set(re.findall(r"^    \(([\w-]+) \?", text, re.MULTILINE))
    used = set(re.findall(r"\(([\w-]+) \?", text)) - {"exists", "forall"}
    assert used <= declared
    assert {"is-open", "holds-rh", "p-grabbable", "seat-limit-4", "loosely-close"} <= declared


@pytest.mark.parametrize(("file", "make"), [("actions.md", action_table), ("domain.pddl", domain)])
def test_generated_texts_are_as_reviewed(knowledge, file, make):
    """Refresh with `python cli.py kb export table --to tests/golden/kb/actions.md` (and `pddl`, `domain.pddl`)."""
    assert make(knowledge) == (GOLDEN / file).read_text(encoding="utf-8")


def test_other_forms(knowledge, tmp_path):
    assert export(knowledge, "graphml", tmp_path / "kb.graphml") == ""
    assert (tmp_path / "kb.graphml").read_text().count("<node ") > 700
    assert export(knowledge, "duckdb", tmp_path / "kb.duckdb") == ""
    assert (tmp_path / "kb.duckdb").stat().st_size > 0
    for form, message in (("yaml", "`yaml` is not a form"), ("duckdb", "a database needs a file")):
        with pytest.raises(HearthError, match=message):
            export(knowledge, form)
