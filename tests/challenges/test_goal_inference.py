"""Goal inference from states: what it reads, how it counts, what it learns."""

from __future__ import annotations

import importlib.util
from dataclasses import replace
from itertools import product
from random import Random

import numpy as np
import pytest
from scrambled_worlds import hiding_places

from hearth.challenges.challenge_definition import challenge
from hearth.challenges.demonstration_episodes import Wish, demonstrate
from hearth.challenges.learning_to_watch import examples, goals_of_tests
from hearth.challenges.published_tasks import tasks
from hearth.challenges.watch_stage import bound, inferred
from hearth.kb.loading.load import default
from hearth.models.interface import Training
from hearth.models.watching.demonstration_batches import Joining, Watched, epoch, packed
from hearth.models.watching.goal_decoding import PossibleGoals, possible_goals
from hearth.models.watching.goal_inference import GoalInference, TrainedGoalInference, restored
from hearth.models.watching.object_sightings import HELD, Layout, Seen, sightings
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.literals import Literal
from hearth.simulation.observation import visible_nodes
from hearth.simulation.world.bits import indices
from hearth.simulation.world.edit import edit

GRAMMAR = challenge("wah").grammar
LAYOUT = Layout.of(GRAMMAR.predicates)
TEXTS = tuple(map(str, GRAMMAR.predicates))
FEW = tasks("wah", "test-1", limit=10)


@pytest.fixture(autouse=True)
def torch_is_there():
    if importlib.util.find_spec("torch") is None or importlib.util.find_spec("safetensors") is None:
        pytest.skip("the extra `models` is not installed")


@pytest.fixture(scope="module")
def shown():
    return examples(tasks("wah", "demonstrations", limit=12), default)


@pytest.fixture
def possible():
    return possible_goals(tuple(GRAMMAR.goals), TEXTS)


def seen_of(task, knowledge, change=lambda tick: tick):
    ticks = [change(tick) for tick in demonstrate(Wish(task, 1.0, default)).ticks(knowledge)]
    return sightings(ticks, tuple(bound(task, ticks[0].before.home)))


def test_layout_has_a_cell_for_each_predicate_and_is_the_same_for_names_and_nodes(knowledge):
    assert len(set(LAYOUT.cells)) == 30
    home = FEW[0].demonstration_start(knowledge).home
    assert Layout.of(tuple(bound(FEW[0], home))) == LAYOUT


def test_what_is_wanted_was_seen_where_it_is_wanted(knowledge):
    for task in FEW[:5]:
        seen = seen_of(task, knowledge)
        for (kind, place), count in zip(LAYOUT.cells, GRAMMAR.counts(task.goal), strict=True):
            assert sum(thing.kind == kind and thing.places[-1] == place for thing in seen) >= count
        assert all(HELD in thing.places or thing.kind == 13 for thing in seen)  # but for the sofa


def test_instructions_and_failures_are_not_read(knowledge):
    blank = seen_of(FEW[1], knowledge, lambda tick: replace(tick, instructions={}, failures={}))
    assert blank == seen_of(FEW[1], knowledge)
    assert len(blank) > 2


def test_what_is_out_of_sight_is_not_read(knowledge):
    chooser, moves = Random(0), []

    def change(tick):
        """Puts a thing that goals are about and that nobody sees somewhere else, where nobody sees it."""
        world = tick.world
        mask = visible_nodes.visible(world, world.agents[0])
        unseen = [i for i in indices(world.home.instances("plate") | world.home.instances("wine")) if not mask >> i & 1]
        places = list(hiding_places(world, mask))
        if not unseen or not places:
            return tick
        moves.append(unseen)
        thing = world.home.ids[chooser.choice(unseen)]
        return replace(tick, world=edit(world, place={thing: chooser.choice(places)}, check=False))

    assert seen_of(FEW[1], knowledge, change) == seen_of(FEW[1], knowledge)
    assert len(moves) > 5


def untrained(seed=0, shape="things"):
    import torch

    torch.manual_seed(seed)
    network = GoalInference(width=16, shape=shape).network(LAYOUT)
    torch.nn.init.normal_((network.counts_for if shape == "things" else network.count).weight)
    network.eval()
    return network


@pytest.mark.parametrize("shape", ["things", "moments"])
def test_answers_depend_neither_on_the_order_of_things_nor_on_the_batch(shown, shape):
    import torch

    network = untrained(shape=shape)
    turned = [replace(each, things=each.things[::-1]) for each in shown]
    with torch.no_grad():
        every = network(packed(shown, 30))
        assert torch.allclose(every, network(packed(turned, 30)), atol=1e-5)
        alone = torch.cat([network(packed([each], 30)) for each in shown])
    assert torch.allclose(every, alone, atol=1e-5)


def test_counts_are_those_of_all_ways_in_which_things_may_count(shown):
    import torch

    from hearth.models.watching.object_network import LEAST

    network = untrained()
    few = replace(shown[0], things=shown[0].things[:4])
    with torch.no_grad():
        batch = packed([few], 30)
        chances, found = network.things(batch)[0].numpy(), network(batch)[0].exp().numpy()
    for number, (kind, place) in enumerate(LAYOUT.cells):
        slow = np.zeros(9)
        ours = [chances[i, place] for i, thing in enumerate(few.things) if thing.kind == kind]
        for way in product((0, 1), repeat=len(ours)):
            slow[sum(way)] += np.prod([p if yes else 1 - p for p, yes in zip(ours, way, strict=True)])
        assert np.allclose(found[number], (1 - LEAST) * slow + LEAST / 9, atol=1e-5)


def test_the_decoded_goal_is_the_best_of_all_goals_and_pairs():
    goals = ((1, 0, 0, 0), (2, 1, 0, 0), (0, 2, 0, 0), (0, 0, 1, 0), (0, 0, 2, 1), (0, 0, 0, 1))
    some = PossibleGoals(goals)
    assert some.set_of == (0, 0, 2, 2)
    pairs = [tuple(map(sum, zip(a, b, strict=True))) for a in goals[:3] for b in goals[3:]]
    for seed in range(200):
        logs = np.log(np.random.default_rng(seed).dirichlet(np.ones(3), 4))
        best = max((*goals, *pairs), key=lambda goal: sum(logs[i, n] for i, n in enumerate(goal)))
        assert some.best(logs) == best


def test_demonstrations_are_joined_to_no_goal_of_a_test_and_to_no_other_of_the_set(shown, possible):
    joining = Joining(LAYOUT, possible.set_of, frozenset())
    both = joining(shown[0], shown[1], Random(0))
    assert both.counts == tuple(map(sum, zip(shown[0].counts, shown[1].counts, strict=True)))
    assert joining(shown[0], shown[0], Random(0)) is None
    assert replace(joining, forbidden=frozenset([both.counts]))(shown[0], shown[1], Random(0)) is None
    assert epoch(shown, joining, 1.0, Random(0)) == epoch(shown, joining, 1.0, Random(0))


def test_a_distraction_that_the_other_goal_would_want_is_left_out(possible):
    joining = Joining(LAYOUT, possible.set_of, frozenset())
    plate = Seen(0, (0, 1, 2), (0.0, 0.1, 0.2))
    apple = Seen(LAYOUT.cells[TEXTS.index("INSIDE(apple, fridge)")][0], (0, 1, 3), (0.0, 0.5, 0.6))
    table = [int(text == "ON(plate, dinnertable)") for text in TEXTS]
    fridge = [int(text == "INSIDE(apple, fridge)") for text in TEXTS]
    both = joining(Watched((plate, apple), tuple(table)), Watched((apple, plate), tuple(fridge)), Random(0))
    assert [thing.kind for thing in both.things] == [plate.kind, apple.kind]


def test_no_goal_of_a_test_is_learnt():
    forbidden = goals_of_tests("wah")
    assert len(forbidden) > 150
    assert not {GRAMMAR.counts(task.goal) for task in tasks("wah", "demonstrations")} & forbidden


def test_the_thesis_s_network_sees_where_each_thing_was_last_at_each_moment():
    import torch

    from hearth.models.watching.state_network import MOMENTS, _places_at

    places, times = torch.tensor([[[2, 5, 0]]]), torch.tensor([[[0.25, 0.75, 0.0]]])
    found = _places_at(places, times)[0, :, 0].tolist()
    expected = [0 if t < 0.25 else 2 if t < 0.75 else 5 for t in np.linspace(0, 1, MOMENTS)]
    assert found == expected


@pytest.mark.parametrize(("shape", "epochs"), [("things", 60), ("moments", 90)])
def test_it_learns_few_demonstrations_by_heart_and_its_checkpoint_answers_the_same(shown, possible, shape, epochs):
    settings = GoalInference(width=32, joined=0.0, dropout=0.0, batch=3, shape=shape)
    how = Training(epochs=epochs, rate=3e-3, patience=0, halve_after=0)
    trained = settings.fit(shown[:8], GRAMMAR.predicates, possible, frozenset(), how)
    assert trained.counts(shown[:8], possible) == [each.counts for each in shown[:8]]
    again = GoalInference.restored(trained.checkpoint())
    assert isinstance(again, TrainedGoalInference)
    assert again.counts(shown, possible) == trained.counts(shown, possible)


def test_the_network_that_comes_with_hearth_infers_goals_that_it_has_not_learnt():
    found = list(inferred(FEW, "states", default))
    assert sum(dict(goal) == dict(task.goal) for goal, task in zip(found, FEW, strict=True)) >= 9


def test_other_predicates_and_models_of_other_readers_are_refused(tmp_path):
    with pytest.raises(HearthError, match="other predicates"):
        restored("goal-inference").infer((), (Literal.of("ON", "plate", "sofa"),), ())
    with pytest.raises(HearthError):
        list(inferred(FEW, "actions", default, model="goal-inference"))
    with pytest.raises(HearthError):
        list(inferred(FEW, "states", default, model=str(tmp_path)))


@pytest.mark.parametrize("predicates", [[], ["x"], [[[]]] * 30, ["x"] * 30, [*TEXTS[:-1], "x"]])
def test_a_checkpoint_of_a_stranger_knows_the_predicates_that_it_says(tmp_path, predicates):
    from hearth.models.checkpoint import load, save
    from hearth.models.model_registry import TRAINED

    found = load(TRAINED / "goal-inference")
    save(replace(found, content={**found.content, "predicates": predicates}), tmp_path)
    with pytest.raises(HearthError):
        restored(str(tmp_path)).infer((), GRAMMAR.predicates, tuple(GRAMMAR.goals))


@pytest.mark.parametrize("what", ["goals", "subgoals"])
def test_what_was_stopped_is_learnt_on_and_gives_the_same_bytes(tmp_path, what, monkeypatch):
    from hearth.challenges import learning, learning_to_help
    from hearth.models.checkpoint import WEIGHTS
    from hearth.models.fit_model import STATE

    small = learning_to_help.Effort(imitation=2, epochs=1, updates=1, episodes=1)
    monkeypatch.setattr(learning_to_help, "EFFORTS", {what: small})
    monkeypatch.setattr(learning_to_help, "VALIDATION", 1)
    monkeypatch.setattr(learning, "PASSES", 3)
    limit = 12 if what == "goals" else 2
    learning.train("wah", what, tmp_path / "whole", default, limit=limit)
    numbers = []

    def stopping(number, _):
        numbers.append(number)
        if len(numbers) == 1:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        learning.train("wah", what, tmp_path / "again", default, limit=limit, trained=stopping)
    assert (tmp_path / "again" / STATE).is_dir()
    learning.train("wah", what, tmp_path / "again", default, limit=limit, trained=stopping)
    assert numbers[1] == 2, "it began again"
    names = sorted(path.name for path in (tmp_path / "whole").iterdir())
    assert names == sorted(path.name for path in (tmp_path / "again").iterdir())
    assert (tmp_path / "whole" / WEIGHTS).read_bytes() == (tmp_path / "again" / WEIGHTS).read_bytes()
