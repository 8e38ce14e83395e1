"""Inputs of ours that are run in a graph, of the kinds of shared cases: what is bound, what is near."""

from __future__ import annotations

from typing import Any, NamedTuple

import pytest
from cases.graphs import BY_HANDS, IN_CABINET, IN_CAN, IN_MICROWAVE, Edge, graph, written
from typer.testing import CliRunner

from hearth.cli import app

BARE = {"category": None, "properties": None}


class Run(NamedTuple):
    """A program that is run in our graph, with the words of the output and the status that are right."""

    case: str
    steps: str
    words: tuple[str, ...]
    status: int = 0
    edges: tuple[Edge, ...] = ()
    changed: dict[int, dict[str, Any]] = {}  # noqa: RUF012
    options: tuple[str, ...] = ()


RULES = ("--rules", "evolving_graph")
GOAL = ("--goal", '{"goal": [], "actions": []}')
CABINET = "bathroomcabinet"
RUNS = (
    Run("05", "[Walk] <remotecontrol> (1); [Grab] <remotecontrol> (1)", ("is remotecontrol (31)",)),
    Run("05", "[Walk] <bathroomcabinet> (1); [Open] <bathroomcabinet> (1)", ("is bathroomcabinet (35)",)),
    Run("05", "[Walk] <clothes_shirt> (1); [Grab] <clothes_shirt> (1)", ("is clothesshirt (33)",)),
    Run("05", "[Walk] <knife> (1)", ("is cutleryknife (34)",)),
    Run("07", "[Walk] <mug> (1.37); [Grab] <mug> (1.37)", ("<mug> to node 37 (mug)",)),
    Run("07", "[Walk] <mug> (1.38); [Walk] <garbagecan> (1.32)", ("node 38 (mug)", "node 32 (garbagecan)")),
    Run("07", "[Walk] <bathroom_cabinet> (1.35); [Open] <bathroom_cabinet> (1.35)", ("node 35 (bathroomcabinet)",)),
    Run("07", "[Walk] <mug> (1.31)", ("is said to be node",), 1),
    Run("55", "<char0> [walk] <mug> (38); <char0> [grab] <mug> (38)", ("mug (38)",)),
    Run("55", "[WALK] <mug> (37); [GRAB] <mug> (37)", ("mug (37)",)),
    Run("55", "<char0> [walk] <cutleryknife> (34)|<char0> [open] <garbagecan> (32)", ("cutleryknife (34)",), 1),
    Run("55", "<char0> [walk] <microwave> (39); <char0> [open] <microwave> (39)", ("microwave (39)",)),
    Run("56", "[Walk] <microwave> (1.39); [Open] <microwave> (1.39); [Grab] <pie> (1.40)", ("Done",), 0, IN_MICROWAVE),
    Run("56", f"[Walk] <{CABINET}> (1); [Open] <{CABINET}> (1); [Grab] <mug> (1.38)", ("Done",), 0, IN_CABINET),
    Run("56", "[Walk] <garbagecan> (1); [Open] <garbagecan> (1); [Grab] <cutleryknife> (1)", ("Done",), 0, IN_CAN),
    Run("56", "[Walk] <microwave> (1.39); [Grab] <pie> (1.40)", ("step 2",), 1, IN_MICROWAVE),
    Run("58", "[Walk] <pie> (1.40); [Grab] <pie> (1.40)", ("1 node without",), 0, (), {40: BARE}),
    Run("58", "[Walk] <microwave> (1); [Open] <microwave> (1)", ("1 node without",), 0, (), {39: BARE}),
    Run("58", "[Walk] <mug> (1.36); [Grab] <mug> (1.36)", ("2 nodes without",), 0, (), {36: BARE, 37: BARE}),
    Run("59", "[Walk] <mug> (1.36); [Grab] <mug> (1.36)", (), 0, (), {36: {"category": "PRE_PRO_Mug_01"}}),
    Run("59", "[Walk] <plate> (1)", (), 0, (), {41: {"category": "FMGP_PRE_Plate_1024"}}),
    Run("59", "[Walk] <garbagecan> (1)", (), 0, (), {32: {"category": "Trashcan_01"}}),
    Run("25", "[Walk] <kitchen> (1); [Rinse] <sink> (1)", ("NOT_CLOSE",), 1, BY_HANDS),
    Run("25", "[Walk] <mug> (1.36); [SwitchOn] <faucet> (1)", ("NOT_CLOSE",), 1, BY_HANDS),
    Run("25", "[Walk] <microwave> (1); [Wash] <sink> (1)", ("NOT_CLOSE",), 1, BY_HANDS),
    Run("25", "[Walk] <bathroom> (1); [SwitchOn] <faucet> (1)", ("Done",), 0, BY_HANDS),
    Run("82", "[Walk] <kitchen> (1); [Touch] <kitchen> (1)", ("Done",), 0, BY_HANDS, {}, ("--rules", "replay")),
    Run("82", "[Walk] <bathroom> (1); [Rinse] <hands_both> (1)", ("Done",), 0, BY_HANDS, {}, ("--rules", "replay")),
    Run("82", "[Walk] <bathroom> (1); [Rinse] <hands_both> (1)", ("NOT_CLOSE",), 1, BY_HANDS, {}, RULES),
    Run("82", "[Walk] <kitchen> (1); [Wash] <hands_both> (1)", ("NOT_CLOSE",), 1, BY_HANDS, {}, RULES),
    Run("13", "[Walk] <mug> (1)", ("Goal: reached.",), 0, (), {}, GOAL),
    Run("13", "[Walk] <mug> (1)", ("Goal: reached.",), 0, (), {}, ("--goal", '{"vh_goal": {"goal": []}}')),
    Run("13", "[Walk] <mug> (1)", ("not a goal",), 1, (), {}, ("--goal", '{"task": "x", "tl_goal": ""}')),
)  # fmt: skip


def call(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.parametrize("given", [pytest.param(run, id=f"{run.case}-{n}") for n, run in enumerate(RUNS)])
def test_a_program_of_the_kind_of_a_case_is_run_as_meant(tmp_path, given):
    home = written(tmp_path / "vh2.json", graph(given.edges, given.changed))
    (tmp_path / "p.txt").write_text("T\nd\n\n\n" + given.steps.replace("; ", "\n") + "\n")
    done = call("run", tmp_path / "p.txt", "--graph", home, "--as-is", *given.options)
    assert done.exit_code == given.status and all(words in done.output for words in given.words), done.output


@pytest.mark.parametrize(
    "wrapped",
    [
        lambda found: {"graph": found},
        lambda found: {"task_id": 4, "task_name": "setup_table", "graph": found},
        lambda found: {"init_graph": found, "final_graph": found},
        lambda found: {"init_graph": found},
        lambda found: [True, found],
    ],
)
def test_a_graph_in_a_wrapper_is_the_graph_that_it_wraps(tmp_path, wrapped):
    assert call("home", "lint", written(tmp_path / "wrapped.json", wrapped(graph()))).exit_code == 0


@pytest.mark.parametrize("category", ["PRE_PRO_Mug_01", "FMGP_PRE_Plate_1024", "Mug(Clone)"])
def test_a_prefab_as_category_is_no_fault(tmp_path, category):
    done = call("home", "lint", written(tmp_path / "vh2.json", graph((), {36: {"category": category}})))
    assert done.exit_code == 0 and "BAD_GRAPH" not in done.output, done.output


@pytest.mark.parametrize(
    ("file", "text"),
    [("a.json", '{"nodes": [], "edges": []}\n\n'), ("b.json", "[]"), ("c.json", '{"title": "T", "steps": ["[Sleep]"]}'),
     ("d.txt", "Tea\n\n\n\n[Walk] <bed> (1)\n")],
)  # fmt: skip
def test_replay_names_what_it_takes(tmp_path, file, text):
    (tmp_path / file).write_text(text)
    done = call("replay", tmp_path / file)
    assert done.exit_code and "release" in done.output and ".jsonl" in done.output, done.output
    assert "damaged" not in done.output
