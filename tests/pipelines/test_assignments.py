"""Crowd batches with several assignments of a task: all answers are read, copies are not."""

from hearth.pipelines.engine.source_labels import labelled
from hearth.pipelines.ingest import items

HEADER = "AssignmentId,AcceptTime,HITId,WorkerId,AssignmentStatus,Input.scene,Answer.title,Answer.description"
ANSWERS = (
    "A1,1,H1,W1,Approved,kitchen,Make tea,I boil water and pour it over the tea.",
    "A2,2,H1,W2,Approved,kitchen,Brew tea,I put the kettle on and wait for the water to boil.",
    "A1,3,H1,W1,Approved,kitchen,Make tea,I boil water and pour it over the tea.",
)


def test_several_assignments_of_a_task_are_several_answers(tmp_path):
    (tmp_path / "batch.csv").write_text("\n".join((HEADER, *ANSWERS)))
    found = [item for _, item in items(labelled([str(tmp_path / "batch.csv")]))]
    assert [item.record_id for item in found if item.reader == "crowd"] == ["crowd:H1", "crowd:H1:A2"]
    assert sum(item.reader == "refused" for item in found) == 1
