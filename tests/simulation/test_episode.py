"""Episodes can be written, read, and done again with the same digest at every tick; whatever differs is found."""

import gzip
import os
import random
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import orjson
import pytest

from hearth.homes import library
from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.schemas.program import ObjectRef, Step
from hearth.simulation.env import Env
from hearth.simulation.episode import Episode
from hearth.simulation.episode_files import read, write
from hearth.simulation.rules import DEFAULT
from hearth.simulation.world.digest import digest
from hearth.simulation.world.edit import edit
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World
from hearth.simulation.world.world_json import export, restore

TICKS = 60


def random_step(env, number, chooser):
    """One of the instructions that are legal, each action as likely as another."""
    legal = env.legal(number)
    action = chooser.choice([*legal.masks, *["Walktowards"] * 20]) if "Walktowards" in legal.masks else "StandUp"
    nodes = [chooser.choice(legal.objects(action, position)) for position in range(len(legal.masks[action]))]
    classes = env.world.home
    return Step(action, tuple(ObjectRef(classes.classes[classes.index[node]], 0, node) for node in nodes), number)


def played(seed, ticks=TICKS, rules=DEFAULT):
    chooser = random.Random(seed)
    env = Env(rules, knowledge=default())
    env.reset(library.names()[seed % 7], 2, seed=seed)
    if seed % 2:
        env.restore(begun(env, chooser))
    for _ in range(ticks):
        env.step({number: random_step(env, number, chooser) for number in (0, 1)})
    return env


def begun(env, chooser):
    """A start in the middle of things: something was added and taken, something is open, strides differ."""
    for _ in range(30):
        env.step({number: random_step(env, number, chooser) for number in (0, 1)})
    first, *rest = env.world.agents
    world = World(env.world.home, env.world.states, (first._replace(stride=3.0), *rest), env.world.moved)
    gone = [node.id for node in world.graph().nodes if node.class_name in ("apple", "book")][:2]
    return edit(world, remove=gone)


@pytest.fixture(scope="module")
def episodes():
    return [Episode.of(played(seed)) for seed in range(4)]


@pytest.fixture(scope="module")
def file(episodes, tmp_path_factory):
    path = tmp_path_factory.mktemp("episodes") / "some.jsonl.gz"
    assert write(path, episodes) == len(episodes)
    return path


def test_an_episode_from_a_file_is_the_recorded_one(episodes, file):
    back = list(read(file, default()))
    assert back == episodes and len(set(back)) == len(back)
    for one, other in zip(episodes, back, strict=True):
        assert one.start.home is not other.start.home
        for (world, mark), (again, mark_again) in zip(one.again(), other.again(), strict=True):
            assert digest(world) == digest(again) and mark == mark_again
            assert [agent.pose for agent in world.agents] == [agent.pose for agent in again.agents]
            assert world.holding() == again.holding()
        assert world.graph().edges == again.graph().edges
        assert other.verify() is None


def test_what_the_second_agent_did_by_text_is_the_same_when_read(tmp_path):
    env = Env(knowledge=default())
    env.reset("maple", 2, seed=1)
    tick = env.step({0: "[Walk] <fridge> (1)", 1: "[Walk] <sofa> (1)"})
    assert [step.agent for step in tick.instructions.values()] == [0, 1]
    write(tmp_path / "one.jsonl", [Episode.of(env)])
    (back,) = read(tmp_path / "one.jsonl", default())
    assert back == Episode.of(env) and back.verify() is None


def test_what_is_written_is_the_same_in_every_process(file):
    """Another process with another hash seed finds each digest again, and writes the same bytes."""
    program = (
        "import sys; from pathlib import Path; from hearth.kb.loading.load import default;"
        "from hearth.simulation.episode_files import read, write; file = Path(sys.argv[1]);"
        "found = list(read(file, default())); assert all(each.verify() is None for each in found), 'differs';"
        "write(file.with_name('again.jsonl.gz'), found)"
    )
    root = Path(__file__).resolve().parents[2]
    for seed in ("1", "77"):
        env = os.environ | {"PYTHONHASHSEED": seed, "MYPYPATH": ""}
        subprocess.run([sys.executable, "-c", program, file], check=True, env=env, cwd=root.parent)
        assert file.with_name("again.jsonl.gz").read_bytes() == file.read_bytes()


@pytest.mark.parametrize("seed", range(8))
def test_one_changed_action_is_found(episodes, seed):
    """Even one that changes nothing in the world."""
    chooser = random.Random(seed)
    episode = chooser.choice(episodes)
    number = chooser.randrange(TICKS)
    agent = chooser.randrange(2)
    other = chooser.choice([Step("Turnleft", (), agent), Step("WakeUp", (), agent)])
    ticks = list(episode.ticks)
    ticks[number] = {**ticks[number], agent: other} if ticks[number][agent] != other else {}
    found = replace(episode, ticks=tuple(ticks)).verify()
    assert found is not None and found.code is Code.REPLAY_DIFFERS and found.line == number + 1


def test_another_start_and_other_rules_are_found(episodes):
    episode = episodes[0]
    agents = episode.start.agents
    moved = (agents[0]._replace(stride=2.0), *agents[1:])
    start = World(episode.start.home, episode.start.states, moved, episode.start.moved)
    assert replace(episode, start=start).verify().line == 0


def test_a_digest_is_of_what_there_is_and_of_nothing_else(maple):
    world = World.start(maple)
    again = World.start(Home.from_graph(world.graph(), "another", default()))
    assert digest(again) == digest(world)
    rebuilt = restore(orjson.loads(orjson.dumps(export(played(2).world))), default())
    assert digest(rebuilt) == digest(played(2).world)
    fridge = maple.ids[maple.classes.index("fridge")]
    opened = edit(world, set=[(fridge, "OPEN")])
    assert digest(opened) != digest(world) == digest(edit(opened, set=[(fridge, "CLOSED")]))


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (b"{", "not an episode"),
        (b'{"ticks": []}', "not an episode: KeyError 'home'"),
        (b"[1]", "not an episode"),
    ],
)
def test_a_file_of_something_else_is_refused_with_its_line(file, tmp_path, line, words):
    lines = gzip.decompress(file.read_bytes()).splitlines()
    bad = tmp_path / "bad.jsonl"
    bad.write_bytes(b"\n".join([lines[0], line]))
    with pytest.raises(HearthError, match=words) as caught:
        list(read(bad, default()))
    assert (caught.value.diagnostics[0].code, caught.value.diagnostics[0].line) == (Code.BAD_JSON, 2)


def test_an_instruction_that_is_none_is_refused(file, tmp_path):
    lines = gzip.decompress(file.read_bytes()).splitlines()
    row = orjson.loads(lines[1])
    row["ticks"][3]["0"] = "[Walk <cup> (1)"
    bad = tmp_path / "bad.jsonl"
    bad.write_bytes(b"\n".join([lines[0], orjson.dumps(row)]))
    with pytest.raises(HearthError, match="is not an instruction"):
        list(read(bad, default()))


@pytest.mark.parametrize(
    ("rules", "words"),
    [({"doors": 2}, "the rule `doors` is 2"), ({"origin": "x"}, "the rule `origin` is 'x'"), ({"x": True}, "'x'")],
)
def test_rules_that_there_are_not_are_refused(file, tmp_path, rules, words):
    lines = gzip.decompress(file.read_bytes()).splitlines()
    bad = tmp_path / "bad.jsonl"
    bad.write_bytes(b"\n".join([lines[0], orjson.dumps({**orjson.loads(lines[1]), "rules": rules})]))
    with pytest.raises(HearthError, match=words):
        list(read(bad, default()))


@pytest.mark.parametrize(
    ("packed", "code"),
    [
        (gzip.compress(bytes(300_000_000), 1), Code.FILE_TOO_LARGE),
        (gzip.compress(b"{}" * 10_000)[:-20], Code.BAD_ARCHIVE),
        (b"{}", Code.BAD_ARCHIVE),
    ],
    ids=["a bomb", "cut off", "not packed"],
)
def test_a_packed_file_that_is_none_is_refused(tmp_path, packed, code):
    path = tmp_path / "bad.jsonl.gz"
    path.write_bytes(packed)
    with pytest.raises(HearthError) as caught:
        list(read(path, default()))
    assert caught.value.diagnostics[0].code is code
