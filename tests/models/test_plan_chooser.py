"""The chooser on the planner: what it learns, what it may look at, and that whatever it chooses runs."""

from __future__ import annotations

import dataclasses
from random import Random

import numpy as np
import pytest
import torch

from hearth.grounding.binding import bind
from hearth.models.checkpoint import load, save
from hearth.models.decoding.next_step_options import Grammar
from hearth.models.interface import Request, Training
from hearth.models.model_registry import restore
from hearth.models.sketches import plan_chooser
from hearth.models.sketches.candidate_choices import Candidate, Choice, joined, packed
from hearth.models.sketches.candidate_ranker import Ranker, best, log_probabilities, loss_of
from hearth.models.sketches.chooser_examples import step_choices
from hearth.models.sketches.name_numbers import Words
from hearth.models.sketches.next_steps import FEWEST, TOOLS, Habits
from hearth.models.sketches.node_features import KINDS, NUMBERS, Places, node_choice
from hearth.models.sketches.plan_chooser import NO_HABITS, SIZES, Chooser, TrainedChooser
from hearth.models.sketches.sketch_examples import grounded
from hearth.models.sketches.sketch_progress import Progress, plain
from hearth.models.sketches.step_features import Offer
from hearth.models.text_examples import corpus
from hearth.repair.sketch_plan import plan, planned_program
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.graph import Edge, EnvironmentGraph
from hearth.schemas.program import Program
from hearth.schemas.syntax import parse_steps
from hearth.scoring.metrics.executability import executability
from hearth.simulation.engine import run
from hearth.simulation.rules import RULES
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

SKETCHES = (
    ("[SwitchOn] <television> (1)", "[Sit] <sofa> (1)"),
    ("[PutIn] <plate> (1) <dishwasher> (1)", "[SwitchOn] <dishwasher> (1)"),
    ("[Grab] <book> (1)", "[Lie] <bed> (1)", "[Read] <book> (1)"),
    ("[Open] <fridge> (1)", "[Drink] <milk> (1)"),
    ("[Fly] <moon> (1)", "[Sleep]"),
)


def sketch_of(lines):
    return tuple(step for line in lines for step in parse_steps(line))


@pytest.fixture(scope="module")
def asked(environments):
    """Sketches in some environments."""
    worlds = environments[::16]
    return [Request(str(n), sketch=sketch_of(SKETCHES[n % 5]), world=world) for n, world in enumerate(worlds)]


@pytest.fixture(scope="module")
def untrained(knowledge):
    """A chooser with random weights."""
    torch.manual_seed(0)
    settings, words = Chooser(), Words.of(knowledge)
    habits = Habits(frozenset({"Walk", "Find", "Grab", "Release", "Open", "Close", "StandUp", "LookAt"}), (), {})
    rankers = {
        "nodes": settings.ranker(words, SIZES["nodes"]),
        "steps": settings.ranker(words, SIZES["steps"]),
    }
    for ranker in rankers.values():
        torch.nn.init.normal_(ranker.rest[-1].weight)
        ranker.eval()
    return TrainedChooser(settings, words, habits, rankers, {})


def test_whatever_is_chosen_runs(untrained, asked):
    for request, program in zip(asked, untrained.predict(asked), strict=True):
        assert executability(program, request.world).executable
        assert len(program) <= 60


def test_the_planner_always_runs(asked):
    for request in asked:
        program = planned_program(request.sketch, request.world)
        assert executability(program, request.world).executable
        assert program or not request.sketch


def test_a_node_is_called_as_in_the_sketch_where_that_name_affords_what_is_done(knowledge):
    sketch = sketch_of(("[Eat] <food_food> (1.7)",))
    eaten = sketch_of(("[Grab] <food_cereal> (1.7)", "[Eat] <food_cereal> (1.7)"))
    opened = (*sketch_of(("[Open] <food_cereal> (1.7)",)), *eaten)
    assert [step.objects[0].name for step in plan_chooser._named(eaten, sketch, knowledge)] == ["food_food"] * 2
    assert plan_chooser._named(opened, sketch, knowledge) == opened


def test_a_plan_knows_which_of_its_steps_are_the_sketch(environments):
    for world in environments[:10]:
        sketch = Program(steps=sketch_of(SKETCHES[2]))
        bound = bind(sketch, world)
        steps = (bound.apply(sketch) if hasattr(bound, "apply") else sketch).steps
        steps = tuple(step for step in steps if all(ref.node for ref in step.objects))
        for step, source in plan(steps, world):
            assert source < 0 or step == steps[source]


def test_without_choices_it_is_the_planner(untrained, asked):
    """Of nodes and of steps."""
    bare = dataclasses.replace(untrained, rankers={}, settings=Chooser(nodes=False, style=False))
    for request, program in zip(asked, bare.predict(asked), strict=True):
        expected = planned_program(request.sketch, request.world)
        home = request.world.home
        assert [plain(step, home) for step in program] == [plain(step, home) for step in expected]


def test_an_answer_does_not_depend_on_the_others(untrained, asked):
    few = asked[:4]
    together = untrained.predict(few)
    assert untrained.predict(few[::-1]) == together[::-1]
    assert [untrained.predict([each])[0] for each in few[:2]] == together[:2]


def test_names_of_nodes_in_a_sketch_say_nothing(untrained, asked):
    """A request may have a bound sketch, if its reference was one; its nodes are not looked at."""
    request = asked[0]
    other = request.world.home.ids[0]
    named = Program(steps=request.sketch)
    named = named.bound({ref.key: other for ref in named.objects()})
    assert untrained.predict([Request("0", sketch=named.steps, world=request.world)]) == untrained.predict([request])


def choices_of(count, seed):
    random = Random(seed)
    return [
        Choice([random.randrange(9)], [3, 4], [0.5], [Candidate([random.randrange(9)], [random.random()])
        for _ in range(random.randint(2, 6))], 1) for _ in range(count)
    ]  # fmt: skip


def test_untrained_loss_is_the_logarithm_of_the_choices():
    choices = packed(choices_of(50, 0))
    expected = np.log(np.diff(choices.starts)).mean()
    assert float(loss_of(Ranker(9, 1, 1, 1, 1), choices).detach()) == pytest.approx(expected, abs=1e-5)


def test_scores_do_not_depend_on_the_batch():
    torch.manual_seed(1)
    ranker = Ranker(9, 1, 1, 1, 1).eval()
    torch.nn.init.normal_(ranker.rest[-1].weight)
    choices = choices_of(20, 1)
    together = ranker(packed(choices))
    apart = torch.cat([ranker(packed([each])) for each in choices])
    assert torch.allclose(together, apart, atol=1e-6)
    starts = torch.as_tensor(packed(choices).starts)
    total = log_probabilities(together, starts).exp().sum()
    assert float(total.detach()) == pytest.approx(20, abs=1e-3)


def test_parts_and_joins_of_choices():
    choices = choices_of(12, 2)
    whole = packed(choices)
    again = joined([whole.part(range(5)), whole.part(range(5, 12))])
    for one, other in zip(whole, again, strict=True):
        assert np.array_equal(one, other)
    assert np.array_equal(whole.part([7, 2]).candidate_names, packed([choices[7], choices[2]]).candidate_names)


def test_it_learns_eight_programs_by_heart(knowledge, dataset):
    """Each choice of eight executions is then right."""
    found = corpus(dataset, "activities", originals=False)
    examples = [each for each in (*found.train, *found.validation) if any(each.keep)][:8]
    assert len(examples) == 8
    words = Words.of(knowledge)
    habits = Habits.of([(each.sketch, each.steps) for each in examples], knowledge)
    batch = packed(step_choices(list(grounded(dataset, examples)), habits, words))
    assert len(batch) > 20
    torch.manual_seed(0)
    ranker = Chooser(dropout=0.0, hidden=64).ranker(words, [column.shape[1] for column in (batch[0], *batch[2:5])])
    optimiser = torch.optim.Adam(ranker.parameters(), lr=1e-2)
    for _ in range(80):
        optimiser.zero_grad()
        loss_of(ranker, batch).backward()
        optimiser.step()
    right = np.array(best(ranker(batch), torch.as_tensor(batch.starts))) == batch.right
    assert right.mean() > 0.97


def test_training_and_a_round_trip(dataset, tmp_path, asked, monkeypatch):
    found = corpus(dataset, "activities", originals=False)
    assert any(any(each.keep) for each in found.train)
    some = tuple(each for each in found.train if any(each.keep))[:12]
    found = dataclasses.replace(found, train=some, validation=some)
    budgets = []
    train = plan_chooser.train
    monkeypatch.setattr(plan_chooser, "train", lambda task, how, seen: budgets.append(how.minutes) or train(task, how))
    trained = Chooser(hidden=16, batch=32, programs=4).fit(found, Training(epochs=2, minutes=9))
    assert budgets == [9, 9], "as `model train --help` says"
    save(trained.checkpoint(), tmp_path)
    restored = Chooser.restored(load(tmp_path))
    assert restored.predict(asked[:2]) == trained.predict(asked[:2])
    again = Chooser(hidden=16, batch=32, programs=4).fit(found, Training(epochs=2, minutes=9))
    for name, value in trained.checkpoint().weights.items():
        assert np.array_equal(value, again.checkpoint().weights[name])


def test_candidates_have_the_plan_and_the_sketch(environments, knowledge):
    words, habits = Words.of(knowledge), NO_HABITS
    for world in environments[:20]:
        sketch = Program(steps=sketch_of(SKETCHES[0]))
        steps = planned_program(sketch.steps, world)
        progress = Progress.start(tuple(step for step in steps if step.action in ("SwitchOn", "Sit")), world)
        grammar = Grammar(world.home)
        for _ in steps:
            offer = Offer(progress, grammar.options(progress.world), habits, words)
            if progress.proposed is None:
                break
            assert progress.proposed in offer.candidates
            execution = run(progress.world, Program(steps=(progress.proposed,)))
            progress = progress.after(progress.proposed, execution.final)


def test_habits_do_not_depend_on_the_order_of_sets(knowledge):
    """Of classes that are used as often, the first by name: the order of a set is another one in each run."""
    tools = ("pan", "bowl", "knife", "spoon", "cup", "plate", "glass", "fork")
    lines = ["[SwitchOn] <stove> (1)", *(f"[Grab] <{name}> (1)" for name in tools)]
    steps = sketch_of(lines)
    habits = Habits.of([(steps[:1], steps)] * FEWEST, knowledge)
    assert habits.tools["stove"] == tuple(sorted(tools)[:TOOLS])


def test_a_candidates_numbers(environments, knowledge):
    for world in environments[:5]:
        places = Places(world, sketch_of(SKETCHES[1]), Words.of(knowledge))
        for use in places.objects:
            if places.candidates[use.key]:
                choice = node_choice(places, use, {})
                assert {(len(each.names), len(each.numbers)) for each in choice.candidates} == {(KINDS, NUMBERS)}


def test_ids_are_not_looked_at(knowledge, environments):
    """Things that were added for a program have the highest ids; another numbering gives the same features."""
    world: World = environments[0]
    places = Places(world, sketch_of(SKETCHES[1]), Words.of(knowledge))
    before = {use.key: node_choice(places, use, {}).candidates for use in places.objects if places.candidates[use.key]}
    graph = world.graph()
    moved = EnvironmentGraph(
        tuple(dataclasses.replace(node, id=node.id + 5000) for node in graph.nodes),
        tuple(Edge(e.source + 5000, e.relation, e.target + 5000) for e in graph.edges),
    )
    other = Places(World.start(Home.from_graph(moved, "moved", knowledge)), sketch_of(SKETCHES[1]), Words.of(knowledge))
    after = {use.key: node_choice(other, use, {}).candidates for use in other.objects if other.candidates[use.key]}
    assert before == after


def test_the_planner_is_a_model(asked):
    name, model = restore("planner")
    assert name == "planner"
    assert model.predict(asked) == [planned_program(each.sketch, each.world) for each in asked]


def test_a_checkpoint_with_other_features_is_refused(untrained, tmp_path):
    """As those of older versions."""
    whole = untrained.checkpoint()
    sizes = {**whole.content["sizes"], "steps": [15, 22, 3, 44]}
    save(dataclasses.replace(whole, content={**whole.content, "sizes": sizes}), tmp_path)
    with pytest.raises(HearthError, match="other features"):
        restore(tmp_path)


@pytest.mark.parametrize(("name", "stripped"), [("default", True), ("made_bed", False)])
def test_a_program_runs_by_the_rules_of_its_request(untrained, maple, name, stripped):
    request = Request("x", sketch=sketch_of(["[Lie] <bed> (1)"]), world=World.start(maple), rules=RULES[name])
    (planned,), (chosen,) = (model.predict([request]) for model in (restore("planner")[1], untrained))
    assert all(
        steps and run(request.world, Program(steps=steps), RULES[name]).executable for steps in (planned, chosen)
    )
    assert any(step.action == "Grab" for step in planned) == stripped
