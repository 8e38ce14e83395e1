"""Public functions raise our own errors, whatever they are called with."""

from __future__ import annotations

import inspect
import random
from pathlib import Path

import pytest

import hearth
from hearth.schemas.call_errors import explained
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code, Failure
from hearth.schemas.program import ObjectRef, Program, Step
from hearth.simulation.engine import act

TEXT = "Milk\n\n[Walk] <fridge> (1)\n[Open] <fridge> (1)\n"
CUP = ObjectRef("cup", 1, 1)
STEPS = [
    Step("PutBack", (CUP,)), Step("Walk"), Step("StandUp", (CUP,)), Step("Walk", (ObjectRef("x", 1, "a"),)),
    Step("Walk", (ObjectRef("x", 1, None),)), Step("Walk", (CUP,), agent=-1), Step("Walk", (CUP,), agent=7),
    Step("Walk", (1, 2)), Step(None), Step("Walk", None), Step("Grab", (CUP,) * 3),
]  # fmt: skip
PROGRAMS = [*(Program(steps=(step,)) for step in STEPS), Program(steps=None), Program("a", "b", ("x",))]


@pytest.fixture(scope="module")
def calls():
    """Return the callables of the package, with arguments that are right."""
    known, home = hearth.knowledge(), hearth.home("maple")
    graph, world, program = hearth.load_graph("maple", known), hearth.World.start(home), hearth.parse_program(TEXT)
    bound, goal = hearth.bind(program, world).apply(program), hearth.Goal.of(hearth.Literal.of("CLEAN", "cup"))
    env = hearth.Env()
    env.reset(world)
    return {
        "run": (hearth.run, world, bound), "bind": (hearth.bind, program, world),
        "infer": (hearth.infer, program, known),
        "sample": (hearth.sample, program, home, 0), "augment": (hearth.augment, program, home, 0),
        "sketch": (hearth.sketch, program, [home], known), "load_graph": (hearth.load_graph, "maple", known),
        "generate": (hearth.generate, 3, 0, known), "understand": (hearth.understand, known, "walk to the fridge"),
        "find": (hearth.find, known, hearth.Query()), "holds": (hearth.holds, goal.counts[0][0], world),
        "edit": (hearth.edit, world), "parse_program": (hearth.parse_program, TEXT, known), "load": (hearth.load, "x"),
        "parse_steps": (hearth.parse_steps, "1. Walk to the fridge", known),
        "home": (hearth.home, "maple", known), "knowledge": (hearth.knowledge, None),
        "executability": (hearth.executability, bound.steps, world), "evaluate": (hearth.evaluate, [], known),
        "read_pairs": (hearth.read_pairs, Path("x")), "verify": (hearth.verify, "x"),
        "export": (hearth.export, None, "jsonl", Path("x")), "World.start": (hearth.World.start, home),
        "Home.from_graph": (hearth.Home.from_graph, graph, "x", known), "Dataset.open": (hearth.Dataset.open, "x"),
        "Progress.start": (hearth.Progress.start, goal, world), "World.has_state": (world.has_state, 1, "OPEN"),
        "World.changes": (world.changes, world), "Env.reset": (env.reset, home, 1, 0),
        "Env.restore": (env.restore, world),
        "Env.step": (env.step, "[Walk] <fridge> (1)"), "Env.observe": (env.observe, 0), "Env.legal": (env.legal, 0),
    }  # fmt: skip


NAMES = [
    "run", "bind", "infer", "sample", "augment", "sketch", "load_graph", "generate", "understand", "find", "holds",
    "edit", "parse_program", "parse_steps", "load", "home", "knowledge", "executability", "evaluate", "read_pairs",
    "verify", "export", "World.start", "Home.from_graph", "Dataset.open", "Progress.start", "World.has_state",
    "World.changes", "Env.reset", "Env.restore", "Env.step", "Env.observe", "Env.legal",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES)
def test_wrong_arguments_are_errors_of_ours(calls, name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert set(calls) == set(NAMES)
    function, *right = calls[name]
    others = [argument for _, *arguments in calls.values() for argument in arguments]
    wrong = [None, 0, -1, 3.5, "", "nonsense", b"x", [], {}, (), object(), ["a"], {0: "x"}, 10**6, *STEPS, *PROGRAMS]
    wrong += random.Random(0).sample(others, 12)
    for place in range(len(right)):
        for value in wrong:
            given = [*right[:place], value, *right[place + 1 :]]
            try:
                function(*given)
            except HearthError as error:
                assert error.diagnostics and all(fault.code in Code for fault in error.diagnostics)


def test_the_argument_and_what_it_should_be_are_named(calls):
    _, world, bound = calls["run"]
    with pytest.raises(HearthError, match=r"BAD_ARGUMENT: run: `program` is int, not Program \(call run\(world: World"):
        hearth.run(world, 3)
    with pytest.raises(HearthError, match=r"`program.steps\[0\].objects\[0\]` is str, not ObjectRef"):
        hearth.run(world, Program(steps=(Step("Walk", ("x",)),)))
    with pytest.raises(HearthError, match="missing a required argument: 'program'"):
        hearth.run(world)
    with pytest.raises(HearthError, match="no room for 999,999 more"):
        hearth.Env().reset("maple", 10**6)
    assert hearth.run(world, bound).executable


@pytest.mark.parametrize(
    ("step", "code"), [(STEPS[0], "WRONG_ARITY"), (STEPS[2], "WRONG_ARITY"), (STEPS[5], "UNKNOWN_AGENT")]
)
def test_a_step_that_cannot_be_is_a_failure(calls, step, code):
    result = act(calls["run"][1], step)
    assert isinstance(result, Failure) and result.code == code


def test_what_fails_though_its_arguments_fit_stays_what_it_is():
    @explained
    def divided(number: int, by: float = 1) -> float:
        return number / by

    assert divided(6, by=2) == 3 and inspect.signature(divided).parameters.keys() == {"number", "by"}
    with pytest.raises(ZeroDivisionError):
        divided(1, 0)
    with pytest.raises(HearthError, match="`by` is str, not float") as caught:
        divided(1, "x")
    assert isinstance(caught.value.__cause__, TypeError)


def test_an_unknown_id_is_a_key_error(tmp_path):
    (tmp_path / "milk.txt").write_text(TEXT)
    dataset = hearth.build([tmp_path / "milk.txt"], tmp_path / "out", homes=("maple",), pictures=0).dataset
    dataset = hearth.load(dataset)
    for ask in (dataset.__getitem__, dataset.home, lambda name: dataset.to_tensors([name])):
        with pytest.raises(KeyError, match="nobody"):
            ask("nobody")
    with pytest.raises(HearthError, match=r"`program_ids` is int, not Iterable\[str\]"):
        dataset.to_tensors(3)
