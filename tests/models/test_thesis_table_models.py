"""A table refuses models that it has no row for, and says which it takes."""

from __future__ import annotations

import pytest

from hearth.models import thesis_table_models
from hearth.models.model_registry import MODELS
from hearth.models.sketches import sketch_result_tables
from hearth.models.text import text_result_tables
from hearth.models.thesis_table_models import KINDS, fits, refuse_others
from hearth.models.thesis_table_plan import PLANS
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code

TAKES = {
    "4.5": ("mle", {"desc2sketch", "planner", "chooser", "films-mle", "demo2sketch", "goal-inference"}),
    "5.2": ("chooser", {"mle", "desc2sketch", "retrieve-edit", "demo2sketch", "films-mle", "helping-actions"}),
    "5.3": ("unaries", {"mle", "chooser", "retrieve-sketch"}),
    "5.4": ("desc2sketch", {"mle", "retrieve-edit", "demo2sketch", "clips-seen"}),
    "5.5": ("demo2sketch", {"mle", "desc2sketch", "films-mle"}),
    "A.4": ("retrieve-sketch", {"mle", "planner", "films-mle"}),
}


@pytest.mark.parametrize("table", TAKES)
def test_models_that_a_table_takes(table, monkeypatch):
    monkeypatch.setattr(thesis_table_models, "named", lambda model: model)
    taken, refused = TAKES[table]
    refuse_others(table, [taken])
    for name in refused:
        with pytest.raises(HearthError, match=f"table {table} has no row for `{name}`") as caught:
            refuse_others(table, [taken, name])
        (fault,) = caught.value.diagnostics
        said = fault.suggestion.split(", ")
        assert fault.code == Code.BAD_ARGUMENT and taken in " ".join(said) and name not in said


def test_tables_take_the_models_of_their_plans():
    for plan in PLANS.values():
        if plan.table in KINDS:
            for name in (*plan.once, *plan.seeded, *plan.given, *(name for name, _ in plan.varied)):
                assert fits(plan.table, name, MODELS[name]), (plan.table, name)


def test_tables_ask(parted):
    with pytest.raises(HearthError, match="it takes random-retrieval, nearest"):
        text_result_tables.table("4.5", parted, "activities", ["planner"])
    with pytest.raises(HearthError, match="it takes planner, unaries"):
        sketch_result_tables.table("5.2", parted, "activities", ["mle-composed"], most=2)
