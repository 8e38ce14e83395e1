"""Modifiers do what they say, or are refused; wrong ones are faults with their place."""

import random
from dataclasses import replace

import numpy as np
import pytest

from hearth.homes.plans.walkable_floor import REACH, gaps
from hearth.kb.action_grammar import check
from hearth.kb.loading.load import default
from hearth.kb.modifiers import MODIFIERS, faults
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.schemas.syntax import parse_program
from hearth.simulation.engine import act, run
from hearth.simulation.env import Env
from hearth.simulation.episode import Episode
from hearth.simulation.episode_files import read, write
from hearth.simulation.instructions import instruction_of
from hearth.simulation.motion.ground import ground_of
from hearth.simulation.motion.positions import placed
from hearth.simulation.world.bits import indices
from hearth.simulation.world.digest import digest
from hearth.simulation.world.world import World


def step(home, text):
    return instruction_of(text, home)


def id_of(home, name):
    return home.ids[home.classes.index(name)]


@pytest.fixture(scope="module")
def beside(maple):
    """Beside the fridge, which is open."""
    world = placed(World.start(maple))
    for text in ("[Walk] <fridge> (1)", "[Open] <fridge> (1)"):
        world = act(world, step(maple, text))
        assert isinstance(world, World), world
    return world


def test_the_left_hand_takes_and_gives(beside, maple):
    milk = maple.index[id_of(maple, "milk")]
    for hand, other in (("left", "right"), ("right", "left")):
        held = act(beside, step(maple, f"[Grab] <milk> (1) {{hand={hand}}}"))
        assert getattr(held.agents[0], hand) >> milk & 1 and not getattr(held.agents[0], other)
        refused = act(held, step(maple, f"[PutIn] <milk> (1) <fridge> (1) {{hand={other}}}"))
        assert isinstance(refused, Failure) and (refused.code, refused.action) == (Code.NOT_HOLDING, "PutIn")
        put = act(held, step(maple, f"[PutIn] <milk> (1) <fridge> (1) {{hand={hand}}}"))
        assert isinstance(put, World) and not put.agents[0].held
        full = act(held, step(maple, f"[Close] <fridge> (1) {{hand={hand}}}"))
        assert isinstance(full, Failure) and full.code is Code.NO_FREE_HAND
        assert isinstance(act(held, step(maple, f"[Close] <fridge> (1) {{hand={other}}}")), World)


def test_one_stands_and_looks_where_it_is_said(maple):
    world = placed(World.start(maple))
    ground = ground_of(maple).ground
    fridge = maple.index[id_of(maple, "fridge")]
    x, z = ground.ways.points[ground.stands(fridge)[0]].tolist()
    there = act(world, step(maple, f"[Walk] <fridge> (1) {{at={x:.2f},{z:.2f} facing=45}}"))
    assert isinstance(there, World), there
    assert there.agents[0].pose == (pytest.approx(x, abs=0.006), pytest.approx(z, abs=0.006), 45.0)
    for where in ("100,100", "0,0"):
        refused = act(world, step(maple, f"[Walk] <fridge> (1) {{at={where}}}"))
        assert isinstance(refused, Failure) and refused.code is Code.NO_PLACE


def test_one_does_not_stand_behind_a_wall(maple):
    world = placed(World.start(maple))
    ground = ground_of(maple).ground
    behind = [
        (node, cell)
        for node in indices(maple.furniture)
        if ground.box(node) is not None
        for cell in np.flatnonzero(ground.ways.main & (gaps(ground.ways.points, ground.box(node)) < REACH)).tolist()
        if ground.rooms[cell] >= 0 and not maple.inside[node] >> ground.rooms[cell] & 1
    ]
    assert behind
    for node, cell in random.Random(0).sample(behind, 20):
        (x, z), name = ground.ways.points[cell].tolist(), maple.classes[node]
        there = Step("Walk", (ObjectRef(name, 1, maple.ids[node]),), modifiers=(("at", f"{x:.2f},{z:.2f}"),))
        refused = act(world, there)
        assert isinstance(refused, Failure) and refused.code is Code.NO_PLACE, (name, x, z)


def test_a_thing_is_put_on_a_point_of_its_place(beside, maple):
    held = act(beside, step(maple, "[Grab] <milk> (1)"))
    name = "table"
    table = maple.node(maple.index[id_of(maple, name)])
    held = act(held, step(maple, f"[Walk] <{name}> (1)"))
    x, _, z = table.box.center
    put = act(held, step(maple, f"[PutBack] <milk> (1) <{name}> (1) {{at={x + 0.1:.2f},{z:.2f}}}"))
    assert isinstance(put, World), put
    anywhere = act(held, step(maple, f"[PutBack] <milk> (1) <{name}> (1)"))
    assert isinstance(anywhere, World) and digest(put) == digest(anywhere)  # points are for films
    refused = act(held, step(maple, f"[PutBack] <milk> (1) <{name}> (1) {{at={x + 9:.2f},{z:.2f}}}"))
    assert isinstance(refused, Failure) and refused.code is Code.NO_PLACE


def test_a_program_places_its_character_if_it_says_where(maple):
    program = Program(steps=(step(maple, "[Walk] <fridge> (1) {facing=90}"),))
    execution = run(World.start(maple), program)
    assert execution.executable and execution.final.agents[0].pose.yaw == 90
    assert run(World.start(maple), Program(steps=(step(maple, "[Walk] <fridge> (1)"),))).final.agents[0].pose is None


@pytest.mark.parametrize(
    ("line", "column", "found", "words"),
    [
        ("[Grab] <cup> (1) {colour=red}", 19, "colour=red", "unknown modifier `colour`"),
        ("[Grab] <cup> (1) {hand=middle}", 19, "hand=middle", "`middle` is not a value of `hand`"),
        ("[Grab] <cup> (1) {hand=left hand=left}", 29, "hand=left", "a second `hand`"),
        ("[Walk] <cup> (1) {hand=left}", 19, "hand=left", "[Walk] takes no `hand`"),
        ("[Walk] <cup> (1) {at=3}", 19, "at=3", "`3` is not a value of `at`"),
        ("[Walk] <cup> (1) {speed=slow at=1,x}", 30, "at=1,x", "`1,x` is not a value of `at`"),
        ("[Sit] <sofa> (1) {facing=north}", 19, "facing=north", "`north` is not a value of `facing`"),
    ],
)
def test_a_wrong_modifier_is_a_fault_with_its_place(maple, line, column, found, words):
    text = f"Title\n\n\n{line}\n"
    program, _ = parse_program(text, "a.txt")
    _, (fault,) = check(program, default(), "a.txt", text.split("\n"))
    assert (fault.code, fault.line, fault.column, fault.found) == (Code.SYNTAX, 4, column, found)
    assert words in fault.message and fault.suggestion
    with pytest.raises(HearthError) as caught:
        instruction_of(line.replace("cup", "milk").replace("sofa", "couch"), maple)
    assert caught.value.diagnostics[0].column


def test_every_modifier_says_what_it_means_and_its_example_is_one(maple):
    for name, known in MODIFIERS.items():
        actions = [action for group in known.groups for action in default().group(group)] or ["Sleep"]
        assert known.means and not list(faults(Step(actions[0], (), 0, False, ((name, known.example),)), default()))


def test_a_step_with_a_wrong_modifier_is_refused_when_it_is_done(beside, maple):
    ref = ObjectRef("milk", 1, id_of(maple, "milk"))
    refused = act(beside, Step("Grab", (ref,), 0, False, (("hand", "third"),)))
    assert isinstance(refused, Failure) and (refused.code, refused.action) == (Code.NOT_SIMULATED, "Grab")


def test_a_stride_takes_no_place_and_no_way_to_look(maple):
    """The character stands and looks where the stride ends: `at` would be a jump."""
    world = placed(World.start(maple))
    fridge = ObjectRef("fridge", 1, id_of(maple, "fridge"))
    for name, value in (("at", "3,2"), ("facing", "90"), ("hand", "left")):
        with pytest.raises(HearthError, match=f"takes no `{name}`"):
            step(maple, f"[Walktowards] <fridge> (1) {{{name}={value}}}")
        refused = act(world, Step("Walktowards", (fridge,), 0, False, ((name, value),)))
        assert isinstance(refused, Failure) and refused.code is Code.NOT_SIMULATED
    assert isinstance(act(world, step(maple, "[Walktowards] <fridge> (1) {speed=slow}")), World)
    assert isinstance(act(world, step(maple, "[Turnleft] {speed=fast}")), World)


def test_modifiers_are_done_again_with_their_episode(maple, tmp_path):
    env = Env(knowledge=default())
    env.reset(maple)
    box = maple.node(maple.index[id_of(maple, "table")]).box
    x, z = ground_of(maple).ground.ways.points[ground_of(maple).ground.stands(maple.index[id_of(maple, "fridge")])[0]]
    for text in (
        f"[Walk] <fridge> (1) {{at={x:.2f},{z:.2f} facing=45}}", "[Open] <fridge> (1) {hand=left speed=slow}",
        "[Grab] <milk> (1) {hand=left}", "[Walk] <table> (1) {facing=200}",
        f"[PutBack] <milk> (1) <table> (1) {{at={box.center[0]:.2f},{box.center[2]:.2f}}}",
        f"[PutBack] <milk> (1) <table> (1) {{at={box.center[0] + 9:.2f},{box.center[2]:.2f}}}",
    ):  # fmt: skip
        env.step(text)
    assert [bool(tick.failures) for tick in env.ticks] == [False] * 5 + [True]
    assert env.world.agents[0].pose.yaw == 200
    write(tmp_path / "e.jsonl", [Episode.of(env)])
    (again,) = read(tmp_path / "e.jsonl", default())
    assert again.verify() is None and again == Episode.of(env)
    assert [tick[0].modifiers for tick in again.ticks] == [tick.instructions[0].modifiers for tick in env.ticks]
    turned = [{0: replace(again.ticks[0][0], modifiers=(("facing", "46"),))}, *again.ticks[1:]]
    assert replace(again, ticks=tuple(turned)).verify().line == 1
