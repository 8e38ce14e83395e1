"""Work in several processes: stopping it."""

import signal

import pytest

from hearth.storage.parallel import uninterrupted


@pytest.mark.parametrize("error", [None, ValueError("a worker was stopped by the same signal")])
def test_an_interrupt_that_was_held_comes_afterwards(error):
    reached = False
    with pytest.raises(KeyboardInterrupt), uninterrupted():
        signal.raise_signal(signal.SIGINT)
        reached = True
        if error:
            raise error
    assert reached, "it came before the work was given out"


def test_errors_without_an_interrupt_stay_what_they_are():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(ValueError, match="mine"), uninterrupted():
        raise ValueError("mine")
    assert signal.getsignal(signal.SIGINT) is before
