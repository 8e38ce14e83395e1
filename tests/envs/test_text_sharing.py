"""Caches of the text environment change no byte: random play, compared with the plain writer."""

from __future__ import annotations

import random
from hashlib import blake2b

import pytest
from golden_files import compare
from oracles.text_observations import compact as plainly

from hearth.envs.session import opening
from hearth.envs.text_homes import TextHome
from hearth.envs.text_worlds import reason
from hearth.homes import library
from hearth.homes.procedural.home_generator import generate
from hearth.homes.scene_graph import scene
from hearth.schemas.diagnostics import HearthError
from hearth.simulation.world.home import Home

GOALS = ("ON(milk, table): 1, CLOSED(fridge)", "INSIDE(apple, fridge)", "HOLDS(agent, book)", "ON(plate, table): 2")
WRONG = ("fly", "Grab", "Walk zebra", "Open milk 9999", "wait", "")
COMMANDS = 120
GENERATED = 2


def homes(knowledge):
    made = {f"made_{n}": scene(generate(3 + 2 * n, n, knowledge), knowledge) for n in range(GENERATED)}
    return {name: name for name in library.names()} | {
        name: Home.from_graph(graph, name, knowledge) for name, graph in made.items()
    }


def begun(home, seed):
    """A world of a home with the first goal, from one that the seed says, that the home can have."""
    for number in range(len(GOALS)):
        try:
            world = TextHome(opening(home, GOALS[(seed + number) % len(GOALS)], agents=1), limit=60)
            return world, *world.reset(seed)
        except HearthError:
            continue
    raise AssertionError(home)


def answer(chooser, info):
    """A command: a walk, something else, or now and then a mistake."""
    every = list(info["admissible"])
    walks = [each for each in every if each.startswith("Walk")]
    rest = [each for each in every if not each.startswith(("Walk", "Turn"))]
    handling = [each for each in rest if each.startswith(("Grab", "Put", "Open", "Close", "Switch", "Sit", "Stand"))]
    kind = chooser.choice([walks, walks, rest, handling, handling, WRONG if chooser.random() < 0.3 else walks])
    return chooser.choice(kind or every)


def play(home, seed, commands):
    """Yield the world and each answer with all that it was answered."""
    world, text, info = begun(home, seed)
    chooser = random.Random(seed)
    yield world, None, (text, info["ticks"], list(info["admissible"]))
    for number in range(commands):
        if info["won"] or info["ticks"] >= 60:
            text, info = world.reset(seed + number)
            given = None
        else:
            text, reward, terminated, truncated, info = world.step(given := answer(chooser, info))
            given = given, reward, terminated, truncated
        yield world, given, (text, info["ticks"], info["fault"], info["goal_fraction"], list(info["admissible"]))


def written_plainly(world):
    """The observation of a world as the plain writer has it."""
    place, settings = world._homes._places[0], world._homes._play
    now = place.now
    note = "" if now.fault is None else f"refused, you waited. {reason(now.fault)}"
    said = getattr(now.task, "instruction", "")
    return plainly(*place.shown, now.progress.goal, settings.words, said, note, stopped=now.stopped)


@pytest.mark.parametrize("seed", range(2))
def test_observations_are_those_of_the_plain_writer(seed, knowledge):
    for home in homes(knowledge).values():
        for world, _, (text, *_) in play(home, seed, COMMANDS // 3):
            assert text == written_plainly(world)


def test_random_play_gives_the_bytes_that_it_gave_before_anything_was_kept(knowledge):
    """Golden: digests of what an engine and a writer that kept nothing gave for the same commands."""
    found = {}
    for name, home in homes(knowledge).items():
        whole = blake2b(digest_size=8)
        for _, given, answered in play(home, 7, COMMANDS):
            whole.update(repr((given, answered)).encode())
        found[name] = whole.hexdigest()
    compare("text_play.json", found)
