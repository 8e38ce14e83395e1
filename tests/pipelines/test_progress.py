"""Lines of progress."""

import re

import pytest

from hearth.pipelines.engine.progress import line
from hearth.storage.partitions import Counts


@pytest.mark.parametrize(("seconds", "rate"), [(1.0, "3/s"), (42.0, "0.071/s"), (0.25, "12/s"), (0.001, "3,000/s")])
def test_slow_work_has_a_rate_as_well(seconds, rate):
    shown = line("render", Counts(records_in=3, through=3), seconds, True)
    assert re.search(r"\((.*)\)", shown)[1] == rate
