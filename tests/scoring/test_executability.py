import json
import zipfile

import pytest

from hearth.kb.loading.load import default
from hearth.schemas.failures import Code
from hearth.scoring.line_sequences import read
from hearth.scoring.metrics.executability import ErrorClass, executability
from hearth.simulation.rules import REPLAY
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

WALK_FRIDGE, OPEN_FRIDGE = "[Walk] <fridge> (1)", "[Open] <fridge> (1)"
WALK_CUP, GRAB_CUP = "[Walk] <cup> (1)", "[Grab] <cup> (1)"
WALK_CHAIR, SIT_CHAIR = "[Walk] <chair> (1)", "[Sit] <chair> (1)"
PUT = "[PutBack] <cup> (1) <table> (1)"
WALK_TABLE = "[Walk] <table> (1)"

CASES = {
    "words": ([WALK_FRIDGE, "open it"], 1, ErrorClass.SYNTAX, Code.SYNTAX),
    "unknown action": ([WALK_FRIDGE, "[Fly] <cup> (1)"], 1, ErrorClass.UNKNOWN_NAME, Code.UNKNOWN_ACTION),
    "unknown object": (["[Walk] <phlogiston> (1)"], 0, ErrorClass.UNKNOWN_NAME, Code.UNKNOWN_OBJECT),
    "not in this home": (["[Walk] <piano> (1)"], 0, ErrorClass.UNKNOWN_NAME, Code.UNBOUND),
    "nobody's step": (["<char1> [StandUp]"], 0, ErrorClass.UNKNOWN_NAME, Code.UNKNOWN_AGENT),
    "arity": (["[Walk] <fridge> (1) <table> (1)"], 0, ErrorClass.ARITY, Code.WRONG_ARITY),
    "affordance": ([WALK_FRIDGE, "[Drink] <fridge> (1)"], 1, ErrorClass.AFFORDANCE, Code.NOT_AFFORDED),
    "never executed": (["[Dance]"], 0, ErrorClass.NOT_SIMULATED, Code.NOT_SIMULATED),
    "a walk is missing": ([OPEN_FRIDGE], 0, ErrorClass.MISSING_STEP, Code.NOT_CLOSE),
    "a grab is missing": ([WALK_TABLE, PUT], 1, ErrorClass.MISSING_STEP, Code.NOT_HOLDING),
    "standing up is missing": (
        [WALK_CUP, GRAB_CUP, "[Grab] <cup> (2)", WALK_CHAIR, SIT_CHAIR, "[Walk] <television> (1)"],
        5,
        ErrorClass.MISSING_STEP,
        Code.SITTING,
    ),
    "the walk comes too late": ([OPEN_FRIDGE, WALK_FRIDGE], 0, ErrorClass.WRONG_ORDER, Code.NOT_CLOSE),
    "the walk away comes too early": (
        [WALK_FRIDGE, "[Walk] <bedroom> (1)", OPEN_FRIDGE],
        2,
        ErrorClass.WRONG_ORDER,
        Code.NOT_CLOSE,
    ),
    "opened twice": ([WALK_FRIDGE, OPEN_FRIDGE, OPEN_FRIDGE], 2, ErrorClass.ADDITIONAL_STEP, Code.IS_OPEN),
    "already standing": (["[StandUp]"], 0, ErrorClass.ADDITIONAL_STEP, Code.NOT_SITTING_OR_LYING),
    "put twice": ([WALK_CUP, GRAB_CUP, WALK_TABLE, PUT, PUT], 4, ErrorClass.ADDITIONAL_STEP, Code.NOT_HOLDING),
    "dropped twice": (
        [WALK_CUP, GRAB_CUP, "[Drop] <cup> (1)", "[Drop] <cup> (1)"],
        3,
        ErrorClass.ADDITIONAL_STEP,
        Code.NOT_HOLDING,
    ),
    "off already": (
        ["[Walk] <television> (1)", "[SwitchOff] <television> (1)"],
        1,
        ErrorClass.ADDITIONAL_STEP,
        Code.IS_OFF,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_where_and_why_it_first_fails(world, name):
    program, line, error, code = CASES[name]
    found = executability(read(program), world)
    failed_line = None if line is None else line + 1  # lines of a case count from 0
    assert (found.failed_line, found.error, found.code) == (failed_line, error, code)
    assert not found.executable
    assert found.final is None or error is ErrorClass.AFFORDANCE


def test_a_program_that_runs(world):
    found = executability(read([WALK_CUP, GRAB_CUP, WALK_TABLE, PUT]), world)
    assert found.executable
    assert (found.empty, found.failed_line, found.error) == (False, None, None)
    assert ("cup", 20) in [(ref.name, ref.node) for ref in found.program.objects()]
    assert (20, "ON", 10) in found.final.edges()


def test_an_empty_program_is_not_executable_and_says_that_it_is_empty(world):
    found = executability((), world)
    assert (found.empty, found.executable, found.final) == (True, False, world)


def test_the_first_fault_is_the_earliest_whatever_its_kind(world):
    early_run = executability(read([OPEN_FRIDGE, "[Fly] <cup> (1)"]), world)
    early_name = executability(read(["[Fly] <cup> (1)", OPEN_FRIDGE]), world)
    assert (early_run.failed_line, early_run.code) == (1, Code.NOT_CLOSE)
    assert (early_name.failed_line, early_name.code) == (1, Code.UNKNOWN_ACTION)


def test_what_only_the_engine_allows_is_not_executable(world):
    """The engine scrubs whatever one is close to; the grammar takes no room."""
    program = ["[Walk] <kitchen> (1)", "[Scrub] <kitchen> (1)"]
    found = executability(read(program), world)
    assert (found.runs, found.afforded, found.executable) == (True, False, False)
    assert (found.failed_line, found.error) == (2, ErrorClass.AFFORDANCE)
    assert found.final is not None


def test_objects_are_bound_as_the_reference_binds_them(world):
    reference = executability(read(["[Walk] <cup> (1.21)"]), world).program
    found = executability(read([WALK_CUP, GRAB_CUP]), world, reference)
    assert {ref.node for ref in found.program.objects()} == {21}


def test_the_releases_own_programs_are_executable(real_data):
    with zipfile.ZipFile(real_data / "activityprograms-sample.zip") as archive:
        names = [name for name in archive.namelist() if "/executable_programs/" in name and name.endswith(".txt")]
        for name in names[::20]:
            graphs = name.replace("executable_programs", "init_and_final_graphs").replace(".txt", ".json")
            start = World.start(Home.from_release(json.loads(archive.read(graphs))["init_graph"], "", default()))
            assert executability(read(archive.read(name).decode()), start, rules=REPLAY).executable, name
