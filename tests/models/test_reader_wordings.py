"""Words that the reader puts in plainer ones before it reads: shorthand, corrections, and missing commas."""

from hearth.models.reading.clause_marks import marked
from hearth.models.reading.shorthand import written_out
from hearth.models.reading.spoken_corrections import corrected


def test_shorthand_is_written_out():
    assert written_out("pls get the cup n wash it") == "please get the cup and wash it"
    assert written_out("vase -> desk") == "vase to desk" and written_out("I'd like tea") == "I would like tea"


def test_a_request_keeps_to_its_correction():
    assert corrected("Set it on the desk... actually, on the shelf.") == "Set it on the shelf."
    assert corrected("Fill the kettle... no wait, just unplug it.") == "There is the kettle. just unplug it."
    assert corrected("Take it, but don't light it, and put it down.").startswith("Take it, but")


def test_a_first_clause_gets_its_comma():
    assert marked("when i come home i shut the door") == "when i come home, i shut the door"
    assert marked("the sink is where the bowl goes") == "put the bowl to the sink"
    assert marked("she turns the lamp of again") == "she turns the lamp off again"
