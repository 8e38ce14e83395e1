"""Environments in which an original runs and loses its goal: it is repaired, and has nothing to publish of its own."""

import hearth
from hearth.datasets.verify import verify

HEAD = "HITId,Origin,Writer,AssignmentStatus,Input.description_id,Input.title,Input.description,Answer.rooms,Answer.props,Answer.program"  # noqa: E501  # fmt: skip

COFFEE = """[Walk] <kitchen> (1)
[Find] <pot> (1)
[Grab] <pot> (1)
[Find] <water> (1)
[Grab] <water> (1)
[Pour] <water> (1) <pot> (1)
[Find] <stove> (1)
[PutBack] <pot> (1) <stove> (1)
[Find] <coffee> (1)
[Grab] <coffee> (1)
[Pour] <coffee> (1) <pot> (1)
[Find] <stove> (1)
[SwitchOn] <stove> (1)
[TurnTo] <pot> (1)
[LookAt] <pot> (1)
[SwitchOff] <stove> (1)
[Find] <coffee_cup> (1)
[Pour] <coffee> (1) <coffee_cup> (1)"""


def test_the_original_that_runs_is_no_case(tmp_path):
    batch = tmp_path / "programs.csv"
    batch.write_text(f'{HEAD}\nPA01006a,written,finder,Approved,,Make coffee,I brew coffee.,,,"{COFFEE}"\n')
    options = {"homes": ("juniper",), "action_set": 2, "variants": 6, "pictures": 0, "videos": 0}
    made = hearth.build([str(batch)], str(tmp_path / "out"), **options)
    assert made.stages["publish"].rejected == 0
    names = hearth.load(made.dataset).rows("SELECT DISTINCT environment_id FROM repairs WHERE outcome = 'REPAIRED'")[1]
    failed = hearth.load(made.dataset).rows("SELECT DISTINCT environment_id FROM executions WHERE NOT executable")[1]
    assert set(names) - set(failed)
    assert not verify(made.dataset).faults


def test_without_variants_nothing_is_refused_and_the_ledger_says_what_was_left_out(tmp_path):
    """A program's sketch comes with its first execution; nothing was asked of the others."""
    batch = tmp_path / "programs.csv"
    batch.write_text(f'{HEAD}\nPA01006a,written,finder,Approved,,Make coffee,I brew coffee.,,,"{COFFEE}"\n')
    options = {"homes": ("juniper", "maple"), "variants": 0, "pictures": 0, "videos": 0}
    made = hearth.build([str(batch)], str(tmp_path / "out"), **options)
    dataset = hearth.load(made.dataset)
    assert dataset.rows("SELECT count(*) > 1 FROM executions WHERE executable")[1] == [(True,)]
    assert not dataset.rows("SELECT code FROM rejects WHERE stage = 'augment'")[1]
    assert dataset.rows("SELECT count(*) FROM sketches")[1] == [(1,)]
    columns = "records_in, records_through, records_rejected, record"
    ((*numbers, record),) = dataset.rows(f"SELECT {columns} FROM ledger WHERE stage = 'augment'")[1]
    assert numbers == [1, 1, 0] and "no variants were requested" in record
    assert not verify(made.dataset).faults
