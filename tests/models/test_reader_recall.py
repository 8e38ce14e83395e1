"""The reader with a memory: it stores and restores, and weighs its own reading among what is found."""

from dataclasses import asdict, replace

from hearth.models.checkpoint import load
from hearth.models.interface import Request
from hearth.models.model_registry import TRAINED
from hearth.models.reading.reader_recall import ReaderRecall, read_program


def recall(trust):
    kept = load(TRAINED / "retrieve-edit")
    return ReaderRecall.restored(replace(kept, model="reader-recall", settings=asdict(ReaderRecall(trust=trust))))


def test_the_share_of_a_text_that_is_read():
    own, share = read_program(Request("a", "Watch TV", "Turn on the TV. Launch the rocket."))
    assert [step.action for step in own] == ["Walk", "Walk", "SwitchOn"] and share == 0.5
    assert read_program(Request("a", "", "Launch the rocket.")) == ((), 0.0)


def test_a_reader_that_is_trusted_alone_says_what_it_reads():
    request = Request("a", "", "Take the umbrella and put it on the piano.")
    own, _ = read_program(request)
    assert own and recall(1000.0).predict([request]) == [own] != recall(0.0).predict([request])


def test_it_is_stored_and_restored():
    model = recall(0.5)
    again = ReaderRecall.restored(model.checkpoint())
    requests = [Request("a", "Make coffee", "I make coffee and drink it.")]
    assert model.checkpoint().model == "reader-recall" and again.predict(requests) == model.predict(requests)
