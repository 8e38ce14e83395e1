"""A study as it goes on: one thing after the other, once each; places of those who leave go to others."""

import pytest
from studies.small import small

from hearth.kb.loading.load import default
from hearth.schemas.diagnostics import HearthError
from hearth.schemas.failures import Code
from hearth.studies.events import PLACES, Event, FileLedger, MemoryLedger
from hearth.studies.simulated_people import simulated_person
from hearth.studies.study_progress import CONSENT, DONE, EXIT, LEFT, PRACTICE, QUESTIONS, TRIAL, TUTORIAL, Conduct
from hearth.studies.study_simulation import Ahead, play_ahead


class Clock:
    now = 1000.0

    def __call__(self):
        return self.now


@pytest.fixture
def conduct():
    return Conduct(small(), MemoryLedger("salt"), default, Clock())


@pytest.fixture(scope="module")
def record():
    """Makes the record of a planned trial."""
    study = small()
    return lambda planned: play_ahead(Ahead(study, planned, simulated_person(0, 0), default))


def refused(call, *arguments):
    with pytest.raises(HearthError) as caught:
        call(*arguments)
    return caught.value.diagnostics[0]


def test_a_person_goes_one_way(conduct, record):
    stages = [conduct.join("a").stage, conduct.consent("a").stage, conduct.read("a").stage]
    standing = conduct.practised("a")
    assert [*stages, standing.stage] == [CONSENT, TUTORIAL, PRACTICE, TRIAL]
    while standing.stage != EXIT:
        if standing.stage == QUESTIONS:
            standing = conduct.answer("a", {"helpful": 4})
        else:
            standing = conduct.played("a", record(conduct.trial(standing)), 5.0)
    assert conduct.answer("a", {"age": "young"}).stage == DONE
    kinds = [each.kind for each in standing.events]
    assert kinds.count("did") == 2
    assert kinds.count("answered") == 1
    assert conduct.leave("a").stage == DONE


def test_what_is_not_next_is_refused(conduct):
    conduct.join("a")
    assert refused(conduct.read, "a").message == "the study is at `consent`, not at `tutorial`"
    assert refused(conduct.answer, "a", {}).code == Code.BAD_ARGUMENT
    assert refused(conduct.consent, "b").code == Code.UNKNOWN_ID
    assert refused(conduct.standing, "").code == Code.UNKNOWN_ID
    conduct.consent("a")
    assert refused(conduct.consent, "a").code == Code.BAD_ARGUMENT


def test_of_two_windows_one_is_refused(conduct):
    standing = conduct.join("a")
    conduct.consent("a")
    assert refused(conduct._append, standing, "consented", {}).code == Code.CONFLICT
    assert len(conduct.ledger.read("a")) == 1


def at_trial(conduct, person):
    conduct.join(person), conduct.consent(person), conduct.read(person)
    return conduct.practised(person)


def test_a_record_of_another_trial_is_refused(conduct, record):
    standing = at_trial(conduct, "a")
    made = record(conduct.trial(standing))
    other = conduct.slots[standing.place][1]
    assert refused(conduct.played, "a", record(other)).code == Code.REPLAY_DIFFERS
    assert refused(conduct.played, "a", {**made, "final": "0" * 32}).code == Code.REPLAY_DIFFERS
    assert refused(conduct.played, "a", {"task": 1}).code == Code.BAD_JSON
    better = {**made, "metrics": {**made["metrics"], "length": 1, "reward": 1.0}}
    kept = conduct.played("a", better).events[-1].data["record"]
    assert kept["metrics"] == made["metrics"], "metrics are computed here, not taken"


@pytest.mark.parametrize("answer", [0, 8, 4.5, True, "4", None])
def test_an_answer_that_is_not_of_its_question_is_refused(conduct, record, answer):
    standing = at_trial(conduct, "a")
    while standing.stage != QUESTIONS:
        standing = conduct.played("a", record(conduct.trial(standing)))
    assert refused(conduct.answer, "a", {"helpful": answer}).message.startswith("`helpful`: ")
    assert "is not asked" in refused(conduct.answer, "a", {"helpful": 4, "name": "Ann"}).message


def test_places_fill_and_those_of_who_left_are_given_again(conduct):
    places = [conduct.join(name).place for name in "abcd"]
    assert places == [0, 1, 2, 3]
    assert conduct.join("b").place == 1, "who joins again has the place"
    assert refused(conduct.join, "e").message == "every place in this study is taken"
    conduct.leave("c")
    conduct.leave("a")
    assert conduct.join("e").place == 0, "who joined first waits longest"
    assert conduct.join("f").place == 2
    assert refused(conduct.join, "g").code == Code.BAD_ARGUMENT
    assert conduct.standing("a").stage == LEFT


def test_who_gives_no_sign_for_long_has_left(conduct):
    for name in "abcd":
        conduct.join(name)
    conduct.clock.now += 23 * 3600
    conduct.consent("b")
    assert refused(conduct.join, "e").code == Code.BAD_ARGUMENT
    conduct.clock.now += 2 * 3600
    assert conduct.join("e").place == 0
    assert conduct.standing("a").events[-1].data == {"why": "idle"}
    assert conduct.standing("b").stage == TUTORIAL


def test_nothing_is_left_of_who_is_forgotten(conduct, tmp_path):
    header = {"format": "x"}
    conduct.ledger = FileLedger(tmp_path / "events.jsonl", header, "salt")
    for name in ("ann-secret", "b", "c", "d"):
        conduct.join(name)
        conduct.consent(name)
    conduct.forget("ann-secret")
    assert b"ann-secret" not in (tmp_path / "events.jsonl").read_bytes()
    assert refused(conduct.standing, "ann-secret").code == Code.UNKNOWN_ID
    assert conduct.standing("b").stage == TUTORIAL
    again = FileLedger(tmp_path / "events.jsonl", header, "salt")
    assert again.streams() == ["b", "c", "d"]
    assert len(again.read(PLACES)) == 4
    assert conduct.join("e").place == 0


def test_a_line_that_was_half_written_is_cut_off(tmp_path):
    path = tmp_path / "events.jsonl"
    ledger = FileLedger(path, {"format": "x"})
    assert ledger.append(Event("a", 0, "consented", 1.0, {}))
    assert not ledger.append(Event("a", 0, "consented", 1.0, {}))
    whole = path.read_bytes()
    path.write_bytes(whole + b'{"stream":"a","num')
    assert len(FileLedger(path, {"format": "x"}).read("a")) == 1
    assert path.read_bytes() == whole
    with pytest.raises(HearthError, match="another study"):
        FileLedger(path, {"format": "y"})
