"""The failure decides whether a repair helped, never the sentence that reports it."""

from hearth.repair.repair_loop import Attempt, successes
from hearth.schemas.failures import Code, Failure
from hearth.schemas.literals import Literal
from hearth.schemas.program import ObjectRef, Step

OPENED = (Step("Open", (ObjectRef("fridge", 1, 7),)),)
ON, OFF = Literal.of("ON", ("tv", 1)), Literal.of("OFF", ("lamp", 1))


def attempt(number, failure, after=OPENED, missed=()):
    return Attempt(number, 0, failure, "is_closed", (), after, missed)


def test_the_same_failure_in_other_words_came_back():
    first = attempt(0, Failure(Code.IS_CLOSED, 3, 0, "PutIn", (7,), ("fridge",), "OPEN", "CLOSED"))
    again = attempt(1, Failure(Code.IS_CLOSED, 4, 0, "PutIn", (7,), ("fridge",), "an open fridge", "a closed one"))
    assert successes((first, again), None) == (False, True)


def test_another_object_is_another_failure():
    first, other = (attempt(0, Failure(Code.IS_CLOSED, 3, 0, "PutIn", (node,))) for node in (7, 8))
    assert successes((first, other), None) == (True, True)


def test_of_a_missed_goal_the_facts_are_compared():
    lost = Failure(Code.GOAL_LOST, expected="the same words")
    attempts = [attempt(0, lost, missed=missed) for missed in ((ON, OFF), (ON,), (ON,))]
    assert successes(attempts, None) == (True, False, True)


def test_what_changed_nothing_or_came_last_before_giving_up_did_not_help():
    failure = Failure(Code.IS_CLOSED)
    assert successes((attempt(0, failure, after=()),), None) == (False,)
    assert successes((attempt(0, failure),), failure) == (False,)
    assert successes((), None) == ()
