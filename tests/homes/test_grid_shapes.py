"""Shapes in a grid, against scipy's own."""

import numpy as np
import pytest

from hearth.homes.plans import grid_shapes

ndimage = pytest.importorskip("scipy.ndimage")


@pytest.fixture(params=range(12))
def grid(request):
    pick = np.random.default_rng(request.param)
    shape = tuple(pick.integers(1, 40, 2))
    return pick.random(shape) < (0.35, 0.6, 0.9, 0.99)[request.param % 4]


def test_regions_are_numbered_as_scipy_numbers_them(grid):
    np.testing.assert_array_equal(grid_shapes.regions(grid), ndimage.label(grid)[0])


def test_a_spiral_is_one_region():
    grid = np.ones((7, 7), bool)
    grid[1, :6] = grid[1:6, 5] = grid[5, 1:6] = grid[3:6, 1] = grid[3, 1:4] = False
    assert grid_shapes.regions(grid).max() == ndimage.label(grid)[1]


@pytest.mark.parametrize("reach", [0, 1, 2, 3])
def test_erosion_is_scipys(grid, reach):
    disc = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach
    np.testing.assert_array_equal(grid_shapes.eroded(grid, reach), ndimage.binary_erosion(grid, disc))


def test_clearance_is_the_square_of_scipys_distance(grid):
    if grid.all():
        grid[0, 0] = False
    np.testing.assert_allclose(grid_shapes.clearance(grid), ndimage.distance_transform_edt(grid) ** 2)


def test_a_grid_free_throughout_is_far_from_all():
    assert (grid_shapes.clearance(np.ones((3, 4), bool)) >= 25).all()
