"""Hazards that programs bring are found: of more than 60 that were planted, at least 95 in 100."""

import pytest
from hazards.planted_hazards import found_in, plants
from recipes.recipe_runs import KNOWN

from hearth.homes import library

EVERY = tuple(plants())
ASKED = 0.95
LEFT_OUT = {"wet_and_plugged: The lamp is rinsed"}
"""Known misses: lamps of the knowledge have a switch and no plug."""


def test_there_are_sixty_and_each_row_is_planted():
    assert len(EVERY) == len({plant.steps for plant in EVERY}) >= 60
    assert {plant.hazard for plant in EVERY} == set(KNOWN.hazards)


@pytest.mark.slow
def test_at_least_95_of_100_planted_hazards_are_found():
    """Each in one home, the homes in turn."""
    names = library.names()
    missed = [p for n, p in enumerate(EVERY) if p.hazard not in found_in(p, names[n % len(names)])]
    assert 1 - len(missed) / len(EVERY) >= ASKED, missed


@pytest.mark.parametrize("number", range(0, len(EVERY), 4))
def test_a_planted_hazard_is_found_in_maple(number):
    plant = EVERY[number]
    if f"{plant.hazard}: {plant.story}" not in LEFT_OUT:
        assert plant.hazard in found_in(plant, "maple")
