"""Graphs and steps as arrays, against the graphs they are of."""

from __future__ import annotations

import numpy as np
import pytest

import hearth
from hearth.datasets.tensors import EDGE_TYPES
from hearth.schemas.vocabulary import PROPERTIES, STATES

MILK = "release:batch-1/file1_1"


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


def test_every_node_edge_and_step_is_in_its_place(ds):
    names = [MILK, "crowd:P1"]
    found = ds.to_tensors(names)
    runs = [(ds[name].program, run) for name in names for run in ds[name].runs]
    classes = dict(ds.rows("SELECT name, id FROM vocabulary WHERE kind = 'class'")[1])
    actions = dict(ds.rows("SELECT id, name FROM vocabulary WHERE kind = 'action'")[1])
    assert found.actions.shape == (len(runs), max(len(program.steps) for program, _ in runs))
    for number, (program, run) in enumerate(runs):
        graph, mine = run.start, np.flatnonzero(found.graph == number)
        assert found.node_id[mine].tolist() == [node.id for node in graph.nodes]
        assert found.node_class[mine].tolist() == [classes.get(node.class_name, -1) for node in graph.nodes]
        for row, node in zip(mine, graph.nodes, strict=True):
            assert {STATES[i] for i in np.flatnonzero(found.node_states[row])} == set(node.states) & set(STATES)
            assert {PROPERTIES[i] for i in np.flatnonzero(found.node_properties[row])} == set(node.properties)
        inside = np.isin(found.edge_index[0], mine)
        assert (np.isin(found.edge_index[1], mine) == inside).all()
        rooms = {node.id for node in graph.nodes if node.category == "Rooms"}
        ends = found.node_id[found.edge_index[:, inside]].T.tolist()
        edges = [(a, EDGE_TYPES[kind], b) for (a, b), kind in zip(ends, found.edge_type[inside], strict=True)]
        assert edges == [
            (e.source, "INSIDE_ROOM" if e.relation == "INSIDE" and e.target in rooms else e.relation, e.target)
            for e in graph.edges
        ]
        length = found.lengths[number]
        assert [actions[i] for i in found.actions[number][:length]] == [step.action for step in program.steps]
        assert (found.actions[number][length:] == -1).all()
        bound = run.bindings()
        for place, step in enumerate(program.steps):
            objects = [found.node_id[row] for row in found.objects[number, place] if row >= 0]
            assert objects == [bound[ref.key] for ref in step.objects]


def test_after_some_ticks_and_past_the_end(ds):
    (run,) = ds[MILK].runs
    last = ds.to_tensors([MILK], tick=999)
    assert last.edge_type.shape[0] == len(run.final.edges)
    first = ds.to_tensors([MILK], tick=0)
    assert last.edge_index.shape != first.edge_index.shape or (last.edge_index != first.edge_index).any()


def test_nothing_asked_and_nobody(ds):
    found = ds.to_tensors([])
    assert [array.shape for array in found[:3]] == [(0,), (0, len(STATES)), (0, len(PROPERTIES))]
    assert found.edge_index.shape == (2, 0)
    with pytest.raises(KeyError, match="nobody"):
        ds.to_tensors(["nobody"])


def test_types_of_edges_are_published(ds):
    rows = ds.rows("SELECT name FROM vocabulary WHERE kind = 'edge_type' ORDER BY id")[1]
    assert [name for (name,) in rows] == list(EDGE_TYPES)


def test_a_table_as_pandas_arrow_and_relation(ds):
    assert ds.programs.df().shape[0] == ds.programs.to_arrow_table().num_rows == len(ds)
    assert ds.programs.filter("origin = 'crowd'").aggregate("count(*)").fetchall()[0][0] > 0
    assert list(ds[MILK].sketches) == ds.sketches.filter(f"program_id = '{MILK}'").to_arrow_table().to_pylist()
