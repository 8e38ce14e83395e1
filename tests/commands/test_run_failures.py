"""Runs that fail, as text and as JSON, and what `--sample` adds."""

from __future__ import annotations

import json
import os
import re
from itertools import takewhile
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from hearth.cli import app
from hearth.commands.home_changes_before_run import additions, names_of
from hearth.grounding.grounded_run import LEAST, as_given, attempt
from hearth.repair.remedies import stop_reason
from hearth.schemas.failures import Code
from hearth.schemas.graph import Edge, EnvironmentGraph, Node, to_release
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.world import World

GOLDEN = Path(__file__).resolve().parents[1] / "golden/run"
REFRESH = "if the new text is right: HEARTH_REFRESH=1 python -m pytest tests/commands/test_run_failures.py"
TO_FRIDGE = "[Walk] <fridge> (1)\n"
PAGES = {
    "inside_closed": TO_FRIDGE + "[Grab] <milk> (1)\n[Walk] <sofa> (1)\n[Drink] <milk> (1)\n",
    "not_close": TO_FRIDGE + "[SwitchOn] <television> (1)\n",
    "not_facing": "[Walk] <television> (1)\n[Watch] <television> (1)\n",
    "not_in_room": "[Walk] <bedroom> (1)\n[Watch] <television> (1)\n",
    "sitting": "[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n" + TO_FRIDGE,
    "standing": "[StandUp]\n[Sleep]\n",
    "not_afforded": "[Walk] <sofa> (1)\n[Open] <sofa> (1)\n",
    "already_closed": TO_FRIDGE + "[Close] <fridge> (1)\n",
    "unbound": TO_FRIDGE + "[Walk] <fridge> (2)\n[Open] <fridge> (2)\n",
    "missing": "[Walk] <shower> (1)\n",
    "no_free_hand": TO_FRIDGE + "[Open] <fridge> (1)\n[Grab] <milk> (1)\n[Grab] <juice> (1)\n[Grab] <milk> (2)\n",
    "not_simulated": "[Crawl] <bed> (1)\n",
    "two_characters": "<char0> [Walk] <fridge> (1) | <char1> [Grab] <milk> (1)\n",
}


def call(tmp_path, text, *options, status=1):
    file = tmp_path / "p.txt"
    file.write_text(f"A plan\n\n\n{text}")
    found = CliRunner().invoke(app, ["run", str(file), *options])
    assert found.exit_code == status, found.output
    return found.stdout


@pytest.mark.parametrize("page", PAGES)
def test_golden_pages_of_runs_that_fail(tmp_path, page):
    printed = call(tmp_path, PAGES[page], "--home", "maple", "--explain")
    file = GOLDEN / f"{page}.txt"
    if os.environ.get("HEARTH_REFRESH"):
        file.write_text(printed, "utf-8")
    assert printed == file.read_text("utf-8"), REFRESH
    assert len(re.findall(r"^step \d+ failed: ", printed, re.MULTILINE)) == 1
    assert not re.search(r"can't be placed|\btick\b|found it has some", printed)


@pytest.mark.parametrize("page", PAGES)
def test_text_and_json_say_the_same(tmp_path, page):
    found = json.loads(call(tmp_path, PAGES[page], "--json", "--explain"))
    failure = found["failure"]
    assert failure["message"] in call(tmp_path, PAGES[page])
    assert failure["message"].startswith(f"step {failure['step']} failed: {found['steps'][failure['step'] - 1]}")
    assert failure["message"].endswith(f"({failure['code']})") and failure["why"] in failure["message"]
    assert failure["tick"] == len(found["changes"]) and not found["executable"] and not found["sampled"]
    done = [each for each in found["checks"] if each["tick"] < failure["tick"]]
    assert all(check["held"] for each in done for check in each["checks"])
    assert [each["step"] for each in found["checks"]] == list(range(1, len(found["checks"]) + 1))


def test_the_check_that_fails_is_the_last_and_has_the_facts(tmp_path):
    found = json.loads(call(tmp_path, PAGES["inside_closed"], "--json", "--explain"))
    checks = found["checks"][-1]["checks"]
    assert [(check["literal"], check["held"]) for check in checks] == [
        ("affords(o)", True), ("close(a, o)", True), ("not hidden(o)", False),
    ]  # fmt: skip
    printed = call(tmp_path, PAGES["inside_closed"], "--explain")
    assert "milk (143): CLOSED CLEAN; INSIDE fridge (137), in kitchen (109)" in printed
    assert "fridge (137): CLOSED" in printed and "2 later steps were not run." in printed


def test_the_second_object_of_a_step_is_the_one_that_fails(tmp_path):
    text = TO_FRIDGE + "[Open] <fridge> (1)\n[Grab] <milk> (1)\n[PutBack] <milk> (1) <bed> (1)\n"
    found = json.loads(call(tmp_path, text, "--json", "--explain"))
    assert found["failure"]["code"] == Code.NOT_CLOSE and found["failure"]["names"][0] == "bed"
    assert found["checks"][-1]["checks"][-1] == {"literal": "close(a, s)", "by": "", "held": False}


def test_as_it_is_nothing_is_added(tmp_path):
    for options in ((), ("--as-is",)):
        found = json.loads(call(tmp_path, "[Walk] <sofa> (1)\n", "--json", *options, status=0))
        assert set(found["added"]) == {"objects", "states", "moved", "edges", "removed_edges"}
        assert not any(found["added"].values()) and not found["added_nodes"]
    call(tmp_path, "[Walk] <sofa> (1)\n", "--as-is", "--sample", status=2)


def test_a_character_that_is_added_is_printed(tmp_path):
    printed = call(tmp_path, "<char0> [Walk] <fridge> (1) | <char1> [Walk] <sofa> (1)\n[Sleep]\n")
    assert "added 1 object: character (" in printed and "step 3 failed: [Sleep]" in printed


def test_what_is_sampled_is_counted_and_needed(tmp_path):
    printed = call(tmp_path, PAGES["missing"], "--sample", status=0)
    assert "as it is, step 1 failed: [Walk] <shower> (1): the home has no shower" in printed
    assert "added 1 object: shower (1000) " in printed
    found = json.loads(call(tmp_path, PAGES["missing"], "--sample", "--json", status=0))
    assert found["sampled"] and found["added"]["objects"] == 1 == len(found["added_nodes"])
    assert found["additions"]["objects"][0]["class_name"] == "shower"


def test_a_graph_of_ones_own_gets_only_what_is_needed(tmp_path, maple):
    nodes = [node for node in World.start(maple).graph().nodes if node.category in ("Rooms", "Characters")]
    ids = {node.id for node in nodes}
    edges = [e for e in World.start(maple).graph().edges if e.source in ids and e.target in ids]
    file = tmp_path / "small.json"
    file.write_text(json.dumps(to_release(EnvironmentGraph(tuple(nodes), tuple(edges)))))
    text = "[Walk] <television> (1)\n[SwitchOn] <television> (1)\n"
    assert "the home has no television" in call(tmp_path, text, "--graph", str(file))
    found = json.loads(call(tmp_path, text, "--graph", str(file), "--sample", "--json", status=0))
    assert found["home"] == "small" and found["added"]["objects"] <= 3
    assert call(tmp_path, text, "--home", str(file)).startswith("A plan, in small")


LINES = [
    "[Walk] <shower> (1)", "[Walk] <fridge> (1)", "[Open] <fridge> (1)", "[Grab] <milk> (1)", "[Walk] <cat> (1)",
    "[Walk] <sofa> (1)", "[Sit] <sofa> (1)", "[Walk] <television> (1)", "[SwitchOn] <television> (1)",
    "[Drink] <milk> (1)",
]  # fmt: skip


@settings(max_examples=40, deadline=None)
@given(lines=st.lists(st.sampled_from(LINES), min_size=1, max_size=5), seed=st.integers(0, 50))
def test_what_is_printed_is_the_difference_of_the_graphs(maple, lines, seed):
    program, _ = parse_program("T\n\n\n" + "\n".join(lines) + "\n")
    first = as_given(program, maple, seed)
    assert bool(stop_reason(first.execution)) == (first.execution.failure is not None)
    trial = attempt(program, maple, seed, size=LEAST)
    start = World.start(maple).graph()
    for one in (first, trial):
        if not hasattr(one, "execution"):
            continue
        after = one.execution.worlds[0].graph()
        found = additions(start, after)
        old, new = {node.id: node for node in start.nodes}, {node.id: node for node in after.nodes}
        assert {each.id for each in found.objects} == new.keys() - old.keys()
        changed = [(i, state) for i in old for state in set(new[i].states) - set(old[i].states)]
        assert {f"{old[i].class_name} ({i}) is {state}" for i, state in changed} <= set(found.states)
        assert len(found.states) == len(changed)
        moved = {e for e in set(after.edges) - set(start.edges) if e.source in old and e.target in old}
        loud = {e for e in moved if e.relation not in ("CLOSE", "FACING")}
        assert len([line for line in found.moved if "no longer" not in line]) == len(loud)
        assert set(found.edges) == set(after.edges) - set(start.edges)
        assert set(found.removed_edges) == set(start.edges) - set(after.edges)
        assert_every_edge_is_printed(found, names_of(start, after))


def assert_every_edge_is_printed(found, names):
    """Each edge stands in the lines, once for a pair that is CLOSE in both directions, and the counts add up."""
    text = list(found.lines(names))
    for word, edges in (("added", found.edges), ("removed", found.removed_edges)):
        heads = [n for n, line in enumerate(text) if re.match(rf"{word} \d+ edges?: ", line)]
        assert len(heads) == bool(edges)
        if not edges:
            continue
        head = text[heads[0]]
        counts = [int(number) for number in re.findall(r"(\d+) [A-Z]", head)]
        assert sum(counts) == len(edges) == int(head.split()[1])
        block = list(takewhile(lambda line: line.startswith("  "), text[heads[0] + 1 :]))
        printed = set()
        for line in block:
            source, _, relations = line.strip().partition(": ")
            for part in relations.split("; "):
                relation, _, targets = part.partition(" ")
                printed |= {(source, relation, target) for target in targets.split(", ")}
        assert printed | {(b, r, a) for a, r, b in printed if r == "CLOSE"} >= {
            (names[e.source], e.relation, names[e.target]) for e in edges
        }
        assert len(printed) == len({(*sorted((a, b)), r) if r == "CLOSE" else (a, b, r) for a, r, b in printed})


def test_a_run_that_samples_prints_every_edge_and_never_advises_sampling(tmp_path):
    for page in PAGES:
        if page == "two_characters":
            continue
        file = tmp_path / "p.txt"
        file.write_text(f"A plan\n\n\n{PAGES[page]}")
        text = CliRunner().invoke(app, ["run", str(file), "--sample"]).stdout
        found = json.loads(CliRunner().invoke(app, ["run", str(file), "--sample", "--json"]).stdout)
        assert "--sample" not in text and "--sample" not in json.dumps(found)
        for key, word in (("edges", "added"), ("removed_edges", "removed")):
            count = found["added"][key]
            assert count == len(found["additions"][key])
            assert (f"  {word} {count} edge" in text) == bool(count)


def test_a_run_as_it_is_advises_sampling_where_it_may_help(tmp_path):
    assert "`--sample`" in call(tmp_path, PAGES["missing"])
    assert "`--sample`" in json.loads(call(tmp_path, PAGES["missing"], "--json"))["failure"]["remedy"]
    assert "--sample" not in call(tmp_path, PAGES["not_close"])
    assert "--sample" not in call(tmp_path, "[Walk] <sofa> (1)\n[Drink] <sofa> (1)\n")


def test_no_place_is_said_in_plain_words():
    before = EnvironmentGraph((), ())
    after = EnvironmentGraph((Node(1, "cup", "Tableware", (), ()), Node(2, "kitchen", "Rooms", (), ())), ())
    found = additions(before, after)
    assert [each.place for each in found.objects] == ["in no room", "in no room"]
    held = EnvironmentGraph((*after.nodes, Node(3, "character", "Characters", (), ())), (Edge(3, "HOLDS_RH", 1),))
    assert additions(after, held).objects[0].class_name == "character"
    assert additions(before, held).objects[0].place == "held by character (3)"


@pytest.mark.parametrize(
    ("steps", "advice"),
    [
        ("[Grab] <milk> (1)\n", "walk to the milk and open the fridge first"),
        ("[Walk] <fridge> (1)\n[Grab] <milk> (1)\n", "open the fridge first"),
        ("[SwitchOn] <television> (1)\n", "walk to the television first"),
    ],
)
def test_all_steps_that_are_missing_are_advised_at_once(tmp_path, steps, advice):
    (tmp_path / "a.txt").write_text(f"Title\n\n\n{steps}")
    done = CliRunner().invoke(app, ["run", str(tmp_path / "a.txt"), "--home", "maple"])
    assert done.exit_code == 1 and f"; {advice} (" in done.stdout
