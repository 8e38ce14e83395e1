"""Work in several processes: stopping it."""

import signal
import subprocess
import sys

import pytest

from hearth.storage.parallel import uninterrupted

pytestmark = pytest.mark.usefixtures("interruptible")


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


IN_WORKERS = """
import signal
from hearth.storage.parallel import spread
print(list(spread(signal.raise_signal, [signal.SIGINT] * 4, 2)))
"""


@pytest.mark.parametrize(("here", "ends"), [(signal.SIG_IGN, False), (signal.default_int_handler, True)])
def test_workers_ignore_the_keyboard_where_their_build_does(here, ends):
    """A shell lets what it starts with `&` ignore interrupts; workers that did not were reported as killed."""
    signal.signal(signal.SIGINT, here)
    done = subprocess.run([sys.executable, "-c", IN_WORKERS], check=False, capture_output=True, text=True)
    assert (done.returncode != 0) == ends == ("BrokenProcessPool" in done.stderr), done.stderr
    assert ends or done.stdout == "[None, None, None, None]\n"
