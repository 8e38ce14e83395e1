"""The funnel: what is printed is what the ledger has, and says what the records of each stage are."""

from __future__ import annotations

from typer.testing import CliRunner

import hearth
from hearth import cli
from hearth.pipelines.engine.stages import RECORDS, STAGES


def test_the_printed_rows_are_the_ledger_s(inputs, tmp_path):
    words = ["build", inputs / "programs/evening.txt", inputs / "crowd", "--out", tmp_path / "out", "-j", 1]
    more = ["--homes", inputs / "homes", "--home", "cabin", "--pictures", 0, "--per-program", 3]
    result = CliRunner().invoke(cli.app, [*map(str, words), *map(str, more)])
    assert result.exit_code == 0, result.output
    printed = {line.split()[0]: line.replace(",", "") for line in result.output.splitlines() if line.split()[:1]}
    ds = hearth.load(tmp_path / "out")
    columns = "records_in, records_through, records_rejected, partial_rejects, rows, record"
    found = ds.rows(f"""SELECT stage, {columns} FROM ledger ORDER BY "order" """)[1]
    assert [row[0] for row in found] == list(STAGES) == list(RECORDS)
    for name, *numbers, record in found:
        assert [int(word) for word in printed[name].split()[1:6]] == numbers
        assert record == RECORDS[name] and record.replace(",", "") in printed[name]
    ((refused,),) = ds.rows("SELECT count(*) FROM rejects WHERE stage = 'augment' AND partial")[1]
    assert refused == found[3][4] > 0
    rows = sum(number for (number,) in (ds.rows(f"SELECT count(*) FROM {name}")[1][0] for name in PER_CASE))
    assert found[5][5] == rows


PER_CASE = ("programs", "environments", "executions", "perturbations", "repairs")
