"""Tables 4.4 and 4.5: rows beside the thesis's and yardsticks, and models whose programs are repaired."""

from __future__ import annotations

import pytest

from hearth.models.fit_model import fit
from hearth.models.text.text_result_tables import COLUMNS, table
from hearth.schemas.diagnostics import HearthError

HOW = {"epochs": 1, "minutes": 0.0, "rate": 1e-3, "seed": 0}


@pytest.mark.parametrize("number", ["4.4", "4.5"])
def test_rows(number, parted, tmp_path):
    fit("nearest", parted.folder, tmp_path, "activities", how=HOW)
    rows = table(number, parted, "activities", [tmp_path, tmp_path], repaired=True)
    by_name = {row.method: row for row in rows}
    assert by_name["MLE"].of == "thesis" and by_name["MLE"].scores["mean"] == {"4.4": 0.729, "4.5": 0.410}[number]
    assert {"Empty program", "Random sampling", "Random retrieval", "Nearest description"} <= set(by_name)
    assert by_name["Empty program"].scores["mean"].mean == 0 and by_name["nearest"].seeds == 2
    assert by_name["nearest, repaired"].scores["executable"].mean == 1
    assert set(by_name["nearest"].scores) <= set(COLUMNS)


def test_other_tables_are_named(parted):
    with pytest.raises(HearthError, match=r"there are 4\.4, 4\.5"):
        table("4.9", parted, "activities", [])
