import pytest

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code
from hearth.scoring.evaluate import Options, by_field, evaluate, reference_of, signatures, summarise
from hearth.scoring.line_reader import LineReader
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.executability import ErrorClass
from hearth.scoring.prediction_scores import METRICS
from hearth.scoring.predictions import Pair
from hearth.scoring.refused_rows import FirstFaults
from hearth.simulation.world.world import World

REFERENCE = read(["[Walk] <fridge> (1)", "[Open] <fridge> (1)"])


def pair(name, predicted, reference=REFERENCE, **more):
    return Pair(name, None if predicted is None else read(predicted), reference, 1, more)


PAIRS = [
    pair("same", ["[Walk] <fridge> (1)", "[Open] <fridge> (1)"], activity="a"),
    pair("late", ["[Open] <fridge> (1)", "[Walk] <fridge> (1)"], activity="b"),
    pair("empty", [], activity="a"),
    pair("missing", None),
    pair("words", ["open the fridge"]),
    pair("reference fails", ["[Walk] <fridge> (1)"], read(["[Open] <fridge> (1)"])),
]


@pytest.fixture(scope="module")
def scored(knowledge, world):
    return evaluate(PAIRS, knowledge, lambda _: world)


def values(scored, metric):
    return {each.pair.id: METRICS[metric](each) for each in scored}


@pytest.mark.parametrize(
    ("metric", "expected"),
    [
        ("lcs_step", (1, 0.5, 0, 0, 0, 0)),
        ("parsable", (1, 1, 0, 0, 0, 1)),
        ("parsable_names", (1, 1, 0, 0, 0, 1)),
        ("executable", (1, 0, 0, 0, 0, 1)),
        ("executable_filled", (1, 0, None, 0, 0, 1)),
        ("f1_state", (1, 0, 0, 0, 0, None)),
        ("f1_published", (1, 0, 0, 0, 0, None)),
        ("goal", (1, 0, 0, 0, 0, None)),
        ("goal_fraction", (1, 0, 0, 0, 0, None)),
        ("goal_whole", (1, 0, 0, 0, 0, None)),
        ("goal_whole_fraction", (1, 0, 0, 0, 0, None)),
    ],
)
def test_scores_by_name(scored, metric, expected):
    assert tuple(values(scored, metric).values()) == expected


def test_a_missing_prediction_scores_nothing_even_where_an_empty_one_is_right(knowledge):
    missing, empty = evaluate([pair("a", None, ()), pair("b", [], ())], knowledge)
    assert (missing.lcs.mean, empty.lcs.mean) == (0, 1)


def test_f1_is_nothing_without_a_final_graph_and_not_asked_without_a_reference(scored):
    found = values(scored, "f1")
    assert found["same"] == 1
    assert found["empty"] == 0  # an empty program runs, and shares only the character's place with its reference
    assert found["late"] == found["missing"] == found["words"] == 0
    assert found["reference fails"] is None


def test_summary(scored):
    summary = summarise(scored)
    assert (summary.count, summary.missing, summary.empty, summary.incomparable, summary.inexact) == (6, 1, 1, 1, 0)
    assert summary.errors == {ErrorClass.SYNTAX: 1, ErrorClass.WRONG_ORDER: 1}
    assert summary.failed_at == {1: 2}
    assert summary.means["lcs_step"].mean == 0.25
    assert summary.codes == {Code.SYNTAX: 1, Code.NOT_CLOSE: 1}
    assert (summary.unreferenced, summary.reached_before) == (0, 0)
    assert summary.means["executable"].mean == pytest.approx(2 / 6)
    assert summary.means["executable_filled"].mean == 0.4
    assert summary.means["goal"].mean == 0.2
    assert list(summary.means) == [name for name in METRICS if not name.startswith("safety")]


def test_without_environments_only_programs_are_compared(knowledge):
    summary = summarise(evaluate(PAIRS, knowledge))
    assert list(summary.means) == list(METRICS)[:8]
    assert summary.errors == {}


def test_parts_by_a_field(scored):
    parts = by_field(scored, "activity")
    assert {name: part.count for name, part in parts.items()} == {"": 3, "a": 2, "b": 1}
    assert parts["b"].means["lcs_step"].mean == 0.5


def test_every_score_says_what_it_is():
    assert signatures(Options())["f1"] == "f1|match:swap1|scope:own|empty:1|no_steps:0|v2"
    assert signatures(Options())["f1_published"] == "f1|match:swap1|scope:own|empty:1|v1"
    found = signatures(Options(match="best", scope="either", instances=True, safety="safety|v1"))
    assert found["f1"] == "f1|match:best|scope:either|empty:1|no_steps:0|v2"
    assert found["f1_published"] == "f1|match:best|scope:either|empty:1|v1"
    assert found["lcs_step"] == found["lcs_step_instances"] == "lcs|norm:max|level:step|instances:named|v1"
    assert {name.split("_")[0] for name in METRICS} == {name.split("_")[0] for name in found}


FORMER = {name for name in METRICS if name.endswith("_published") or name.startswith("goal_whole")}
"""Scores as the thesis reads them, each under a name of its own."""

NULL_REFERENCES = [
    "[Walk] <sofa> (1)", "[Walk] <kitchen> (1)", "[TurnTo] <television> (1)", "[Walk] <floor> (1)",
    "[Walk] <fridge> (1)\n[Open] <fridge> (1)", "[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n[StandUp]",
    "[Walk] <television> (1)\n[SwitchOn] <television> (1)\n[SwitchOff] <television> (1)",
]  # fmt: skip
NULL_GOALS = [None, "CLOSED(fridge)", "not HOLDS(agent, milk)", "OPEN(fridge)", "ON(unicorn, table)"]


@pytest.mark.parametrize("reference", NULL_REFERENCES)
def test_no_score_is_won_by_an_empty_program(knowledge, maple, reference):
    """Every score of it is 0, or left out; what the published readings give it has a name of its own."""
    for number, goal in enumerate(NULL_GOALS):
        more = {} if goal is None else {"goal": goal}
        rejects = FirstFaults()
        start = World.start(maple)
        (found,) = evaluate(
            [pair("empty", [], read(reference), **more)], knowledge, lambda _, w=start: w, rejects=rejects
        )
        assert found.empty and found.placed
        won = {name: value for name, metric in METRICS.items() if (value := metric(found))}
        assert set(won) <= FORMER, (goal, won)
        if number == 0 and found.graph:
            assert METRICS["f1_published"](found) == found.graph.both.f1 and METRICS["f1"](found) == 0


def test_a_program_with_steps_has_the_same_f1_by_both_readings(scored):
    for name in ("f1", "f1_state", "f1_relation"):
        ours, published = values(scored, name), values(scored, f"{name}_published")
        assert {k: v for k, v in ours.items() if k != "empty"} == {k: v for k, v in published.items() if k != "empty"}


def test_a_reference_of_several_predictions_runs_once(knowledge, world):
    reference_of.cache_clear()
    evaluate([pair("a", None), pair("b", REFERENCE), pair("c", ["[Walk] <cup> (1)"])], knowledge, lambda _: world)
    assert (reference_of.cache_info().misses, reference_of.cache_info().hits) == (1, 2)


def test_the_title_of_a_numbered_plan_is_not_a_step():
    plan = "Task: Watch TV\nIn the evening.\nStep 1: Walk to television\nStep 2: Watch television"
    found = read(plan, LineReader(default()))
    assert [step.action for step in found] == ["Walk", "Watch"]
