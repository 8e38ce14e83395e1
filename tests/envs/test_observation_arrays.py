"""Observations as arrays, against the graph that the same view gives, and the codes of actions, both ways."""

from __future__ import annotations

import random
from dataclasses import replace

import numpy as np
import pytest

from hearth.envs.action_codes import Listed, Triples, fixed_list, played, str_step
from hearth.envs.goal_arrays import GOAL_COLUMNS, JOINS, class_number
from hearth.envs.node_slots import Slots
from hearth.envs.observation_arrays import AGENT_COLUMNS, Encoder, Sizes
from hearth.envs.session import opening
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import Step
from hearth.schemas.vocabulary import RELATION_ID, RELATIONS, STATES
from hearth.simulation.env import Env
from hearth.simulation.goal_text import read_goal
from hearth.simulation.goals import Progress
from hearth.simulation.instructions import instruction_of
from hearth.simulation.motion import positions
from hearth.simulation.world.edit import edit
from hearth.simulation.world.world import World

GOAL = "ON(plate, table): 2 and HOLDS(agent, milk) and CLOSED(fridge)"
SIZES = Sizes(nodes=400, edges=4096, legal=600)
NAMES = played(default())


@pytest.fixture(scope="module")
def moments(maple):
    """(environment, view, what is legal, progress) at some moments of a random episode of two agents."""
    found = []
    chooser = random.Random(3)
    world, goal = opening(maple, GOAL)(5)
    env = Env(knowledge=maple.knowledge)
    env.restore(world)
    progress = Progress.start(goal, world)
    for number in range(120):
        steps: dict[int, Step | None] = {}
        for agent in (0, 1):
            legal = env.legal(agent, actions=NAMES)
            if number % 10 == 0:
                found.append((env.world, env.observe(agent), legal, progress))
            action = chooser.choice(sorted(legal.masks))
            nodes = [chooser.choice(legal.objects(action, position)) for position in range(len(legal.masks[action]))]
            every = (s for s in legal if s.action == action and [r.node for r in s.objects] == nodes)
            steps[agent] = next(every, None)  # none is about one thing twice
        tick = env.step(steps)
        progress = progress.then(tick.before, tick.world)
    return found


@pytest.fixture(scope="module")
def encoder(maple):
    return Encoder(SIZES, NAMES, maple.knowledge, RELATIONS)


def test_arrays_show_the_graph_of_the_view(moments, encoder):
    for world, view, _, _ in moments:
        rows = encoder.rows(world.home)
        arrays = encoder.arrays(view, rows)
        slot = {world.home.ids[i]: place for place, i in enumerate(rows.slots.order)}
        graph = view.graph
        assert {slot[node.id] for node in graph.nodes} == set(np.flatnonzero(arrays["seen"]).tolist())
        for node in graph.nodes:
            assert arrays["classes"][slot[node.id]] == class_number(node.class_name, world.home.knowledge)
            states = [STATES[n] for n in np.flatnonzero(arrays["states"][slot[node.id]])]
            assert sorted(states) == sorted(set(node.states) & set(STATES))
        edges = {(slot[edge.source], RELATION_ID[edge.relation], slot[edge.target]) for edge in graph.edges}
        assert {tuple(row) for row in arrays["edges"].tolist() if row[0] >= 0} == edges


def test_arrays_say_where_things_and_agents_are(moments, encoder):
    for world, view, _, _ in moments:
        rows = encoder.rows(world.home)
        arrays = encoder.arrays(view, rows)
        for slot, i in enumerate(rows.slots.order):
            expected = positions.spot(world, i) if view.mask >> i & 1 else None
            box = world.home.node(i).box
            if expected is not None or box is None:
                assert arrays["places"][slot] == pytest.approx(expected or (0.0, 0.0), abs=1e-4)
        me = dict(zip(AGENT_COLUMNS, arrays["agents"][0].tolist(), strict=True))
        pose = world.agents[view.agent].pose
        assert (me["seen"], me["x"], me["z"]) == pytest.approx((1.0, pose.x, pose.z), abs=1e-4)
        held = [world.home.ids[rows.slots.order[slot - 1]] for slot in arrays["hands"][0].tolist() if slot]
        assert list(dict.fromkeys(held)) == list(view.me.holding)  # what is grabbed twice is in both hands
        assert bool(arrays["agents"][1][0]) == bool(view.others)


def test_the_goal_has_a_row_a_literal_with_what_is_seen_of_it(moments, encoder):
    for world, view, _, progress in moments:
        rows = encoder.rows(world.home)
        goal = encoder.arrays(view, rows, progress)["goal"]
        table = [dict(zip(GOAL_COLUMNS, row, strict=True)) for row in goal.tolist()]
        assert [row["wanted"] for row in table] == [2, 1, 1, *[0] * (SIZES.literals - 3)]
        assert table[0]["predicate"] == RELATION_ID["ON"] and table[1]["predicate"] == len(RELATIONS)
        plates = [i for i in rows.slots.ordered(progress.watches[0].met[0]) if view.mask >> i & 1]
        assert table[0]["seen"] == len(plates)
        assert not encoder.arrays(view, rows)["goal"].any()


def test_what_is_not_seen_changes_no_byte(moments, encoder):
    """Other states, and things carried elsewhere, where the agent does not look."""
    scrambled = 0
    for world, view, _, progress in moments:
        unseen = [i for i in range(len(world.home)) if not view.mask >> i & 1]
        states = list(world.states)
        for number in range(0, len(states), 2):
            both = sum(1 << i for i in unseen) & (states[number] | states[number + 1])
            states[number], states[number + 1] = states[number] ^ both, states[number + 1] ^ both
        other = World(world.home, tuple(states), world.agents, world.moved)
        env = Env(knowledge=world.home.knowledge)
        env.restore(other)
        again = env.observe(view.agent)
        if again.mask != view.mask:
            continue  # what was closed is open, so that more is seen
        scrambled += 1
        last = [each.last for each in (view.me, *view.others)]
        rows = encoder.rows(world.home)
        one = encoder.arrays(view, rows, progress, 0.5)
        two = encoder.arrays(again, rows, Progress.start(progress.goal, other), 0.5)
        assert all(one[name].tobytes() == two[name].tobytes() for name in one if name != "last" or not any(last))
    assert scrambled > 5


def test_arrays_are_new_each_time_and_in_their_spaces(moments, encoder):
    gymnasium = pytest.importorskip("gymnasium", reason="spaces need gymnasium")
    spaces = gymnasium.spaces.Dict(encoder.spaces())
    world, view, _, progress = moments[-1]
    rows = encoder.rows(world.home)
    one, two = encoder.arrays(view, rows, progress), encoder.arrays(view, rows, progress)
    assert one in spaces
    assert not any(np.shares_memory(one[name], two[name]) for name in one)
    assert not any(one[name].flags.writeable is False for name in one)


@pytest.mark.parametrize("code", [Triples(NAMES, SIZES.nodes), Listed(NAMES, SIZES.legal)], ids=["triples", "listed"])
def test_every_legal_instruction_has_a_number_and_back(moments, code):
    for world, _, legal, _ in moments:
        slots = Slots.of(world.home, SIZES.nodes)
        masks = code.masks(legal, slots)
        for step in (None, *filter(different, legal)):
            number = code.number(step, legal, slots)
            assert code.read(number, legal, slots) == step
            assert permitted(number, masks)
            if step is not None:
                assert Step(step.action, step.objects) == read(str_step(step), world)


def read(text: str, world: World) -> Step:
    """An instruction from its text, its objects named as `Legal` names them."""
    step = instruction_of(text, world.home)
    return Step(step.action, tuple(replace(ref, instance=0) for ref in step.objects))


def different(step: Step) -> bool:
    return len({ref.node for ref in step.objects}) == len(step.objects)


def permitted(number, masks) -> bool:
    if "action_mask" in masks:
        return bool(masks["action_mask"][number])
    action, *objects = np.asarray(number).tolist()
    allowed = masks["legal_objects"][action]
    return bool(masks["legal_actions"][action]) and all(allowed[n][slot] for n, slot in enumerate(objects))


def test_masks_allow_what_is_legal_and_nothing_else(moments):
    chooser = random.Random(0)
    for world, _, legal, _ in moments:
        slots = Slots.of(world.home, SIZES.nodes)
        triples, listed = Triples(NAMES, SIZES.nodes), Listed(NAMES, SIZES.legal)
        masks = triples.masks(legal, slots)
        count = 0
        for action in range(1, 1 + len(NAMES)):
            if masks["legal_actions"][action]:
                objects = masks["legal_objects"][action]
                count += int(np.prod(objects.sum(axis=1)))
                if world.home.knowledge.arity[NAMES[action - 1]] > 1:
                    count -= int(objects.all(axis=0).sum())  # nothing is put on itself
        assert count == len(legal)
        assert masks_of(listed, legal, slots).sum() - 1 == sum(map(different, legal)) == slots.count(legal)
        for _ in range(200):
            number = [chooser.randrange(1, 1 + len(NAMES)), chooser.randrange(400), chooser.randrange(400)]
            step = triples.read(number, legal, slots)
            used = [*number[: 1 + len(step.objects)], *[0] * (2 - len(step.objects))]
            assert (permitted(used, masks) and different(step)) == (step in legal)


def masks_of(code, legal, slots):
    return code.masks(legal, slots)["action_mask"]


def test_a_list_that_is_too_short_leaves_out_the_last(moments):
    world, _, legal, _ = moments[0]
    slots = Slots.of(world.home, SIZES.nodes)
    short = Listed(NAMES, 10)
    assert masks_of(short, legal, slots).tolist() == [1] * 10
    assert short.read(9, legal, slots) == list(legal)[8]
    with pytest.raises(HearthError, match="has no number"):
        short.number(list(legal)[40], legal, slots)


@pytest.mark.parametrize("number", [-1, 600, 2.5, "1", None, [1, 2], float("nan"), [[1], [2]]])
def test_what_is_no_number_is_refused(moments, number):
    world, _, legal, _ = moments[0]
    slots = Slots.of(world.home, SIZES.nodes)
    with pytest.raises(HearthError) as refused:
        Listed(NAMES, SIZES.legal).read(number, legal, slots)
    assert refused.value.diagnostics[0].code is Code.BAD_ARGUMENT


def test_a_number_without_an_instruction_is_a_failure(moments):
    world, _, legal, _ = moments[0]
    slots = Slots.of(world.home, SIZES.nodes)
    found = Listed(NAMES, SIZES.legal).read(SIZES.legal - 1, legal, slots)
    assert isinstance(found, Failure) and found.code is Code.BAD_ARGUMENT
    step = Triples(NAMES, SIZES.nodes).read([1 + NAMES.index("Grab"), SIZES.nodes - 1, 0], legal, slots)
    assert step.objects[0].node is None


def test_arrays_may_be_about_a_few_things(maple, encoder):
    slots = Slots.of(maple, 8, ["fridge", "milk", "kitchen"])
    assert [maple.classes[i] for i in slots.order] == ["fridge", "milk", "milk", "kitchen"]
    world, _ = opening(maple, GOAL, agents=1)(0)
    env = Env(knowledge=maple.knowledge)
    env.restore(world)
    some = Encoder(Sizes(nodes=8), NAMES, maple.knowledge)
    rows = some.rows(world.home, ["fridge", "milk", "kitchen"])
    legal = env.legal(0, actions=NAMES, only_visible=False)
    assert {str_step(s).split()[0] for s in rows.slots.instructions(legal) if s.objects} == {"[Walktowards]"}
    code = fixed_list(NAMES, rows.slots, {"Walktowards": [maple.ids[slots.order[0]]]})
    assert [str_step(s) for s in code.steps if s.action == "Walktowards"] == ["[Walktowards] <fridge> (0.137)"]
    for number in range(1 + len(code.steps)):
        step = code.read(number, legal, rows.slots)
        assert code.number(step, legal, rows.slots) == number
        assert bool(masks_of(code, legal, rows.slots)[number]) == (step is None or step in legal)


@pytest.mark.parametrize(
    ("things", "size", "message"),
    [(None, 5, "367 nodes"), (["unicorn"], 5, "nothing called 'unicorn'"), ([10**9], 5, "nothing called")],
)
def test_slots_that_cannot_be_are_refused(maple, things, size, message):
    with pytest.raises(HearthError, match=message):
        Slots.of(maple, size, things)


JOINED = (
    "OPEN(microwave) and (CLOSED(fridge) or not (OPEN(fridge))) and exists x. (ON(x, table)) and Grab(agent, plate)"
)


def test_joined_parts_have_rows_that_name_the_row_of_their_word(maple, encoder):
    world, _ = opening(maple, GOAL)(0)
    env = Env(knowledge=maple.knowledge)
    env.restore(world)
    goal = read_goal(JOINED, maple)
    sizes = Sizes(SIZES.nodes, SIZES.edges, SIZES.agents, 12, SIZES.legal)
    wide = Encoder(sizes, encoder.names, encoder.knowledge)
    rows = wide.rows(world.home)
    found = wide.arrays(env.observe(0), rows, Progress.start(goal, world))["goal"]
    table = [dict(zip(GOAL_COLUMNS, map(int, row), strict=True)) for row in found if row[0]]
    words = {number: JOINS[row["predicate"] - 1] for number, row in enumerate(table, 1) if row["kind"] == 3}
    assert list(words.values()) == ["or", "not", "exists"]
    by_word = {word: number for number, word in words.items()}
    assert [(row["kind"], words.get(row["part"], ""), row["branch"]) for row in table] == [
        (1, "", 0), (4, "", 0), (3, "", 0), (1, "or", 1), (3, "or", 2), (1, "not", 1), (3, "", 0), (2, "exists", 1),
    ]  # fmt: skip
    assert table[-1]["subject"] == SIZES.nodes + by_word["exists"] and not any(row["seen"] for row in table)
    assert wide.spaces()["goal"].contains(found)
    with pytest.raises(HearthError, match="8 literals for 6 rows"):
        Encoder(Sizes(SIZES.nodes, literals=6), encoder.names, encoder.knowledge).arrays(
            env.observe(0), rows, Progress.start(goal, world)
        )


def test_arrays_are_those_of_the_home_after_an_edit(maple, encoder):
    """A home that was derived, some of whose nodes are gone."""
    gone = maple.ids[40]
    world = edit(World.start(maple), remove=[gone], check=False)
    slots = Slots.of(world.home, SIZES.nodes)
    assert len(slots.order) == len(maple) - 1
    assert slots.rows([world.home.everything]).sum() == len(maple) - 1
