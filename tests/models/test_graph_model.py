"""ResActGraph and its kin: messages, what a step changes, padding, learning by heart, and decoding."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
import torch

from hearth.models.checkpoint import load, save
from hearth.models.interface import Request, Training
from hearth.models.sketches.graph_inputs import MOST, PAD, GraphInput, batched, graph_input, targets
from hearth.models.sketches.graph_model import GraphModel, TrainedGraphModel
from hearth.models.sketches.graph_network import GraphEncoder, GraphNetwork, loss_of
from hearth.models.sketches.name_numbers import Words
from hearth.models.text_examples import corpus
from hearth.repair.sketch_plan import planned_program
from hearth.schemas.syntax import parse_steps
from hearth.scoring.metrics.executability import executability
from hearth.scoring.metrics.parsability import parsability

SKETCH = tuple(step for line in ("[Grab] <cup> (1)", "[PutBack] <cup> (1) <table> (1)") for step in parse_steps(line))
CHANGES = ("none", "residual", "layer", "recurrent")


@pytest.fixture(scope="module")
def words(knowledge):
    return Words.of(knowledge)


@pytest.fixture(scope="module")
def inputs(environments, words):
    return [graph_input(SKETCH, world, words) for world in environments[:6]]


def model(knowledge, **settings):
    settings = GraphModel(hidden=32, **settings)
    words = Words.of(knowledge)
    actions = tuple(sorted(name for name, action in knowledge.actions.items() if action.executed))
    torch.manual_seed(0)
    return TrainedGraphModel(settings, words, actions, settings.network(words, actions).eval())


def dense(encoder: GraphEncoder, given: GraphInput) -> torch.Tensor:
    """Equations 5.4 to 5.6 written out: for each node, the sum over its incoming edges."""
    labels = [encoder.names(torch.as_tensor(given.classes)), torch.as_tensor(given.labels)]
    state = torch.tanh(encoder.start(torch.cat(labels, 1)))
    size = state.shape[1]
    for _ in range(encoder.rounds):
        sums = [torch.zeros(size) for _ in given.nodes]
        for source, kind, target in given.edges.tolist():
            weight = encoder.message.weight[kind * size : (kind + 1) * size]
            bias = encoder.message.bias[kind * size : (kind + 1) * size]
            sums[target] = sums[target] + weight @ state[source] + bias
        state = encoder.gate(torch.stack(sums), state)
    return state


def test_sparse_messages_are_the_sums_of_the_equations(inputs, words):
    torch.manual_seed(0)
    encoder = GraphEncoder(words.size, 8, 2)
    batch = batched(inputs)
    together = encoder(*(torch.as_tensor(column) for column in (batch.classes, batch.labels, batch.edges)))
    for row, given in enumerate(inputs):
        assert len(given.edges) > 30
        assert torch.allclose(together[row, : len(given.nodes)], dense(encoder, given), atol=1e-5)


def test_without_rounds_edges_count_for_nothing(inputs, words):
    for rounds in (0, 2):
        torch.manual_seed(0)
        encoder = GraphEncoder(words.size, 8, rounds)
        batch = batched(inputs)
        state, without = (
            encoder(torch.as_tensor(batch.classes), torch.as_tensor(batch.labels), torch.as_tensor(edges))
            for edges in (batch.edges, batch.edges[:0])
        )
        assert torch.equal(state, without) == (rounds == 0)


@pytest.mark.parametrize("change", CHANGES)
def test_a_step_changes_the_character_and_its_objects_only(inputs, words, change):
    torch.manual_seed(0)
    network = GraphNetwork(words.size, 5, 8, 16, 2, change)
    memory = network.begin(batched(inputs[:2]))
    after = network.after(memory, torch.tensor([1, 2]), torch.tensor([4, 6]), torch.tensor([9, -1]))
    changed = (after.nodes != memory.nodes).any(2).nonzero().tolist()
    assert changed == ([] if change == "none" else [[0, 0], [0, 4], [0, 9], [1, 0], [1, 6]])


def test_the_reduced_graph_is_the_whole_one_where_nothing_is_left_out(environments, words):
    """With room for all nodes, each is there once with all its edges."""
    world = environments[4]
    whole = graph_input(SKETCH, world, words, most=10_000)
    assert sorted(whole.nodes) == list(range(len(world.home)))
    ids = world.home.ids
    edges = {(ids[whole.nodes[a]], ids[whole.nodes[b]]) for a, kind, b in whole.edges if kind % 2 == 0}
    assert edges == {(edge.source, edge.target) for edge in world.edges()}
    few = graph_input(SKETCH, world, words)
    assert len(few.nodes) <= MOST
    kept = {n for n, node in enumerate(whole.nodes) if node in few.nodes}
    place = {node: n for n, node in enumerate(few.nodes)}
    among = {(place[whole.nodes[a]], k, place[whole.nodes[b]]) for a, k, b in whole.edges.tolist() if {a, b} <= kept}
    assert among == {tuple(edge) for edge in few.edges.tolist()}


def test_scores_depend_neither_on_the_batch_nor_on_padding(inputs, words):
    torch.manual_seed(0)
    network = GraphNetwork(words.size, 5, 8, 16, 2, "residual").eval()
    together = network.scores_first(network.begin(batched(inputs)))
    for row, given in enumerate(inputs):
        alone = network.scores_first(network.begin(batched([given])))[0]
        size = len(given.nodes)
        assert torch.allclose(alone[:size], together[row, :size], atol=1e-5)
        assert torch.allclose(alone[-2:], together[row, -2:], atol=1e-5)


def test_untrained_loss_is_the_logarithm_of_the_choices(inputs, words):
    """Of as many nodes, actions and nodes as there are, once the last layers say nothing."""
    network = GraphNetwork(words.size, 7, 8, 16, 1, "residual")
    for layer in (network.first, network.second, network.act[-1]):
        torch.nn.init.zeros_(layer.weight)
        torch.nn.init.zeros_(layer.bias)
    steps = np.array([[3, 2, 1]])
    found = float(loss_of(network, batched(inputs[:1], [steps])).detach())
    nodes = len(inputs[0].nodes)
    assert found == pytest.approx((np.log(nodes + 2) + np.log(7) + np.log(nodes)) / 3, abs=1e-4)


def test_what_the_graph_leaves_out_is_not_learned_from(inputs, words):
    network = GraphNetwork(words.size, 7, 8, 16, 1, "residual")
    nothing = loss_of(network, batched(inputs[:1], [np.full((3, 3), PAD)]))
    assert float(nothing.detach()) == 0


@pytest.mark.parametrize("change", ["none", "residual"])
def test_random_weights_write_programs_that_parse_and_run(environments, knowledge, change):
    requests = [Request(str(n), sketch=SKETCH, world=world) for n, world in enumerate(environments)]
    trained = model(knowledge, change=change)
    for request, program in zip(requests, trained.predict(requests), strict=True):
        assert parsability(program, knowledge).parsable
        assert executability(program, request.world).executable
    free = trained.free().predict(requests[:20])
    assert sum(executability(p, r.world).executable for r, p in zip(requests, free, strict=False)) < 10


def test_an_answer_does_not_depend_on_the_others(environments, knowledge):
    trained = model(knowledge)
    requests = [Request(str(n), sketch=SKETCH[: 1 + n % 2], world=world) for n, world in enumerate(environments[:6])]
    together = trained.predict(requests)
    assert trained.predict(requests[::-1]) == together[::-1]
    assert [trained.predict([each])[0] for each in requests] == together
    assert trained.predict([Request("no world", sketch=SKETCH)]) == [()]


EIGHT = (
    "[SwitchOn] <television> (1)", "[Sit] <sofa> (1)", "[Open] <fridge> (1)", "[Lie] <bed> (1)",
    "[Grab] <book> (1)", "[Grab] <plate> (1)", "[SwitchOn] <computer> (1)", "[Open] <dishwasher> (1)",
)  # fmt: skip


def test_it_learns_eight_programs_by_heart(environments, knowledge):
    """Decoded freely, the eight programs come out as they are, from sketches and graphs alone."""
    trained = model(knowledge)
    rows, seen = [], []
    for line, world in zip(EIGHT, environments[1:], strict=False):
        sketch = parse_steps(line)
        steps = planned_program(sketch, world)
        given = graph_input(sketch, world, trained.words)
        rows.append((given, targets(steps, given, world, trained.actions)))
        seen.append((sketch, steps, world))
    assert sum(len(steps) > 1 for _, steps, _ in seen) > 4
    network = trained.network.train()
    optimiser = torch.optim.Adam(network.parameters(), lr=1e-2)
    batch = batched(*zip(*rows, strict=True))
    for _ in range(150):
        optimiser.zero_grad()
        loss = loss_of(network, batch)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimiser.step()
    network.eval()
    requests = [Request(str(n), sketch=sketch, world=world) for n, (sketch, _, world) in enumerate(seen)]
    written = trained.free().predict(requests)
    for (_, steps, _), program in zip(seen, written, strict=True):
        wanted = [(step.action, [ref.node for ref in step.objects]) for step in steps]
        assert [(step.action, [ref.node for ref in step.objects]) for step in program] == wanted


def test_training_and_a_round_trip(dataset, tmp_path, environments):
    found = corpus(dataset, "activities", originals=False)
    some = tuple(each for each in found.train if any(each.keep))[:6]
    found = dataclasses.replace(found, train=some, validation=some)
    trained = GraphModel(hidden=16).fit(found, Training(epochs=2))
    save(trained.checkpoint(), tmp_path)
    restored = GraphModel.restored(load(tmp_path))
    requests = [Request(str(n), sketch=SKETCH, world=world) for n, world in enumerate(environments[:3])]
    assert restored.predict(requests) == trained.predict(requests)
