"""A notebook's print of a value of ours is short, whatever the value holds."""

from __future__ import annotations

import dataclasses

import pytest

import hearth
from hearth.schemas.short_repr import LONGEST, brief, cut

TEXT = "Fetch milk\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n[Grab] <milk> (1)\n"


@pytest.fixture(scope="module")
def values(made):
    """Values that the entry points give, by what gives them."""
    known, home = hearth.knowledge(), hearth.home("maple")
    world, program, dataset, env = (
        hearth.World.start(home),
        hearth.parse_program(TEXT),
        hearth.load(made.out),
        hearth.Env(),
    )
    bound = hearth.bind(program, world)
    graphs = hearth.ExecutionGraphs(dataset)
    found = {"known": known, "home": home, "world": world, "program": program, "bound": bound}
    found |= {"dataset": dataset, "env": env}
    found |= {"execution": hearth.run(world, bound.apply(program)), "graphs": graphs, "pair": graphs[0]}
    found |= {"entry": dataset["crowd:P1"], "tensors": dataset.to_tensors(["crowd:P1"])}
    found |= {"reset": env.reset("maple"), "tick": env.step("[Walk] <fridge> (1)"), "legal": env.legal(0)}
    found |= {"verdict": hearth.verify(made.out), "conditions": hearth.infer(program, known)}
    found |= {"understood": hearth.understand(known, "open the fridge"), "sampled": hearth.sample(program, home, 1)}
    return found


def walk(value, path, seen, depth=0):
    """A value of ours and all that it leads to, with the way there."""
    if depth > 4 or id(value) in seen:
        return
    seen[id(value)] = value
    if isinstance(value, dict):
        inside = [(f"{path}[{key!r:.20}]", each) for key, each in list(value.items())[:4]]
    elif isinstance(value, list | tuple) and not hasattr(value, "_fields"):
        inside = [(f"{path}[{n}]", each) for n, each in enumerate(value[:4])]
    elif type(value).__module__.split(".")[0] == "hearth":
        yield path, value
        names = [name for name in dir(value) if not name.startswith("_") and name not in ("connection", "worked_out")]
        inside = [(f"{path}.{name}", getattr(value, name, None)) for name in names]
    else:
        return
    for way, each in inside:
        yield from walk(each, way, seen, depth + 1)


def test_values_print_one_short_line(values):
    seen, kinds = {}, set()
    found = (each for name, value in values.items() for each in walk(value, name, seen))
    for path, value in found:
        kinds.add(type(value).__name__)
        assert len(repr(value)) <= 200, f"{path}: {repr(value)[:300]}"
        assert "\n" not in repr(value), path
    assert kinds >= {"Entry", "Run", "World", "Program", "View", "Home", "EnvironmentGraph", "Knowledge", "Tensors"}


def test_what_an_agent_sees_is_no_number_of_a_hundred_digits(values):
    text = repr(values["reset"])
    assert len(text) < 200 and "bits>" in text


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("program", "Program(title='Fetch milk', description='', steps=<3 items>"),
        ("entry", "Entry('crowd:P1', "),
        ("home", "Home('maple', 367 nodes)"),
        ("graphs", "ExecutionGraphs("),
    ],
)
def test_it_says_what_the_value_is(values, name, text):
    assert repr(values[name]).startswith(text)


def test_a_repr_of_anything_is_short():
    @dataclasses.dataclass
    class Odd:
        many: object
        hidden: int = dataclasses.field(default=0, repr=False)
        __repr__ = brief

    assert repr(Odd([1, 2])) == "Odd(many=[1, 2])"
    assert repr(Odd(10**50)) == "Odd(many=<167 bits>)"
    assert repr(Odd(["a", object()])) == "Odd(many=<2 items>)"
    assert repr(Odd({})) == "Odd(many={})"
    assert repr(Odd(1 / 3)) == "Odd(many=0.333333)"
    assert len(repr(Odd("x" * 10**6))) < 100
    assert len(cut("x" * 500)) == LONGEST
