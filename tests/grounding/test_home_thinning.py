"""Environments of a size that a home is beyond: small things go, the program still runs, the graph stays sound."""

import pyarrow as pa
import pytest

from hearth.datasets.format.case_rows import environment_of, home_of
from hearth.grounding.environments.default_state import prepared
from hearth.grounding.environments.sampling import Size, sample
from hearth.grounding.preconditions.precondition_inference import infer
from hearth.homes import library
from hearth.homes.lint import lint
from hearth.kb.loading.load import default
from hearth.schemas.syntax import parse_program
from hearth.schemas.tables import CASE
from hearth.simulation.world.home import Home
from hearth.simulation.world.world import World

TEA = """Tea
A cup of it.


[Walk] <kitchen> (1)
[Walk] <cup> (1)
[Grab] <cup> (1)
[Walk] <kettle> (1)
[Grab] <kettle> (1)
"""


@pytest.fixture(scope="module")
def willow(knowledge):
    return Home.from_graph(library.load_graph("willow", default()), "willow", knowledge)


@pytest.mark.parametrize("name", ["maple", "willow"])
def test_a_home_that_is_too_large_is_thinned(name, maple, willow, knowledge):
    home = {"maple": maple, "willow": willow}[name]
    program, _ = parse_program(TEA)
    for seed in range(3):
        environment, execution = sample(program, home, seed, size=Size.about(290))
        assert 275 <= len(environment.world.home) <= 305
        assert execution.executable and lint(environment.world.graph(), default()) == ()
        assert infer(program, knowledge)


def test_furniture_stays_and_what_there_is_most_of_goes_first(maple):
    base = prepared(maple)
    thin = base.thinned(330)
    assert len(thin.home) == 330 and thin.whole is base.home
    removed = [base.home.node(base.home.index[node]) for node in thin.removed]
    assert all("GRABBABLE" in node.properties for node in removed)
    classes = {thin.home.classes[i] for i in range(len(thin.home))}
    assert {node.class_name for node in removed} <= classes, "a class is removed while others were there twice"
    assert base.thinned(330) is thin and base.thinned(len(base.home)) is base
    assert lint(World.start(thin.home).graph(), default()) == ()


def test_what_was_left_out_is_stored_and_read_again(maple):
    program, _ = parse_program(TEA)
    environment, _ = sample(program, maple, 0, size=Size.about(290))
    base = environment.base
    row = environment_of(environment, frozenset(World.start(base).edges()))
    table = pa.Table.from_pylist([{"environment": row}], schema=pa.schema([CASE.field("environment")]))
    again = World.start(home_of(table.to_pylist()[0]["environment"], base)).graph()
    now = environment.world.graph()
    assert row["removed_nodes"] and {n.id for n in again.nodes} == {n.id for n in now.nodes}
    assert set(again.edges) == set(now.edges)
