"""A gallery of steps: in different homes, of different actions, the same for the same seed."""

import numpy as np
import pytest

pytest.importorskip("open3d")

from itertools import islice

from hearth.analysis.step_gallery import gallery, homes
from hearth.kb.loading.load import default
from hearth.schemas.syntax import parse_program

STEPS = ("[Walk] <sofa> (1)\n[Sit] <sofa> (1)\n", "[Walk] <fridge> (1)\n[Open] <fridge> (1)\n", "[Walk] <bed> (1)\n")


@pytest.fixture(scope="module")
def programs():
    return [parse_program(f"Do {number}\nIt.\n\n\n{steps}")[0] for number, steps in enumerate(STEPS)]


def test_steps_differ_in_home_and_action_and_come_again(programs):
    one, other = (list(gallery(programs, default(), 2, seed=4, size=(48, 36))) for _ in range(2))
    assert [step.home for step in one] == ["birch", "cedar"]
    assert len({step.step.action for step in one}) == 2 and len({step.hour for step in one}) == 2
    assert all(np.array_equal(a.picture, b.picture) and a.step == b.step for a, b in zip(one, other, strict=True))
    assert one[0].picture.shape == (36, 48, 3)


def test_after_our_homes_come_generated_ones():
    found = list(islice(homes(default(), 0), 9))
    assert [name for name, _ in found][6:] == ["willow", "generated 1", "generated 2"]
    assert all(any(node.box for node in graph.nodes) for _, graph in found)
