"""Sampling depends on seed, program and home alone: not on the order of the pairs nor on Python's hashes."""

import os
import subprocess
import sys

from hearth.grounding.environments.sampling import Size, sample
from hearth.schemas.syntax import parse_program

TEXTS = [
    f"{name}\nGet it.\n\n\n[Walk] <kitchen> (1)\n[Walk] <{thing}> (1)\n[Grab] <{thing}> (1)\n"
    for name, thing in (("One", "cup"), ("Two", "plate"), ("Three", "kettle"))
]

CODE = """
import hashlib
from hearth.kb.loading.load import default
from hearth.grounding.environments.sampling import Size, sample
from hearth.schemas.syntax import parse_program
from hearth.simulation.world.home import Home
from hearth.homes import library as catalog
maple = Home.from_graph(catalog.load_graph("maple", default()), "maple", default())
found = [sample(parse_program(text)[0], maple, 3, "x", size=size)[0]
         for text in TEXTS for size in (Size(), Size.about(290))]
print(hashlib.sha256(repr([(e.nodes, e.added, e.removed, e.states, e.left_out) for e in found]).encode()).hexdigest())
"""


def drawn(text, home, size):
    found, _ = sample(parse_program(text)[0], home, 3, "x", size=size)
    return found.nodes, found.added, found.removed, found.states, found.left_out


def test_whatever_the_order(maple):
    pairs = [(text, size) for text in TEXTS for size in (Size(), Size.about(290))]
    forwards = {pair: drawn(pair[0], maple, pair[1]) for pair in pairs}
    backwards = {pair: drawn(pair[0], maple, pair[1]) for pair in reversed(pairs)}
    assert forwards == backwards and len({repr(found) for found in forwards.values()}) > 2


def test_whatever_the_hashes():
    found = set()
    for seed in ("1", "2"):
        code = f"TEXTS = {TEXTS!r}\n{CODE}"
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
        found.add(done.stdout)
    assert len(found) == 1
