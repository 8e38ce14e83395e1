"""Start and end graphs of many executions, against those that are read one by one."""

from __future__ import annotations

import gc
import pickle
import subprocess
import sys

import numpy as np
import pytest

import hearth
from hearth.datasets.execution_graphs import ExecutionGraphs
from hearth.schemas.diagnostics import HearthError


@pytest.fixture(scope="module")
def ds(made):
    return hearth.load(made.out)


@pytest.fixture(scope="module")
def pairs(ds):
    return ExecutionGraphs(ds)


@pytest.fixture(scope="module")
def one_by_one(ds):
    return {run.row["execution_id"]: (ds[name].program, run) for name in ds for run in ds[name].runs if run.executable}


def test_every_execution_is_as_read_alone(pairs, one_by_one):
    assert [pair.execution_id for pair in pairs] == sorted(one_by_one)
    for pair in pairs:
        program, run = one_by_one[pair.execution_id]
        assert (pair.program, pair.bound) == (program, run.bindings())
        assert (pair.start, pair.final) == (run.start, run.final)
    assert any(pair.start != pair.final for pair in pairs)


def test_it_is_a_sequence_in_any_order(pairs):
    ids = [pair.execution_id for pair in pairs]
    assert len(pairs) == len(ids) > 4
    assert pairs[-1].execution_id == ids[-1]
    assert [pair.execution_id for pair in pairs[1:4]] == ids[1:4]
    assert [pair.execution_id for pair in pairs.__getitems__([3, 0, 3])] == [ids[3], ids[0], ids[3]]
    assert pairs[:0] == []
    with pytest.raises(IndexError):
        pairs[len(ids)]


def test_shares_are_read_one_after_the_other(monkeypatch, pairs):
    monkeypatch.setattr("hearth.datasets.execution_graphs.SHARE", 2)
    asked = []
    monkeypatch.setattr(ExecutionGraphs, "_read", lambda self, ids: asked.append(list(ids)) or list(ids))
    found = iter(pairs)
    assert [next(found), next(found), next(found)] == list(pairs.ids[:3])
    assert asked == [list(pairs.ids[:2]), list(pairs.ids[2:4])]


def test_named_executions(ds, pairs):
    names = [pairs.ids[2], pairs.ids[0]]
    assert [pair.execution_id for pair in ExecutionGraphs(ds, names)] == names


def test_batches_are_arrays_of_the_graphs(ds, pairs):
    start, final = pairs.collate(pairs[:3])
    for arrays, tick in ((start, 0), (final, 999)):
        for number, pair in enumerate(pairs[:3]):
            alone = ds.to_tensors([pair.execution_id.rpartition("@")[0]], tick)
            assert arrays.lengths[number] == alone.lengths[0] == len(pair.program.steps)
        mine = ds.to_tensors([pairs[0].execution_id.rpartition("@")[0]], tick)
        first = np.flatnonzero(arrays.graph == 0)
        assert (arrays.node_states[first] == mine.node_states[: len(first)]).all()


def test_it_is_sent_to_workers_without_its_connection(pairs):
    pairs[0]
    copy = pickle.loads(pickle.dumps(pairs))
    assert copy._opened is None and copy[0] == pairs[0]


def test_a_folder_is_not_a_dataset(pairs):
    with pytest.raises(HearthError, match="`dataset` is str, not Dataset"):
        ExecutionGraphs(str(pairs.folder))


def test_it_needs_no_torch():
    code = "import sys; sys.modules['torch'] = None; import hearth.datasets.execution_graphs"
    subprocess.run([sys.executable, "-c", code], check=True)


def collected(worker):
    gc.collect()


@pytest.mark.parametrize("shuffle", [False, True])
def test_torch_loads_batches_with_workers(pairs, shuffle):
    torch = pytest.importorskip("torch", reason="torch is not installed: pip install torch")
    from torch.utils.data import DataLoader

    pairs[0]  # workers that are forked must neither use this connection nor close it
    garbage = [hearth.load(pairs.folder)]
    garbage[0].rows("SELECT 1")
    garbage.append(garbage)  # collected in the workers, too
    del garbage
    loader = DataLoader(pairs, 4, shuffle=shuffle, num_workers=2, collate_fn=pairs.collate, timeout=60,
                        worker_init_fn=collected)  # fmt: skip
    lengths = torch.cat([torch.from_numpy(start.lengths) for start, _ in loader]).tolist()
    assert sorted(lengths) == sorted(len(pair.program.steps) for pair in pairs)
    assert len(loader) == -(-len(pairs) // 4)
