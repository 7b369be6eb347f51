"""From SI units to whole numbers."""

import numpy as np

from lube.grid.discretise import LineGrid, whole_numbers

GRID = LineGrid(spacing=1e-6, height_step=1e-12)


def test_films_and_windows_are_whole_steps_and_a_film_above_all_heights_stays_so():
    films, half_windows = whole_numbers([1e-9, 2.6e-12], [3.9e-6, 1e-6], GRID)
    assert films.tolist() == [1000, 3] and half_windows.tolist() == [3, 1]
    films, _ = whole_numbers([1.0, 1e9, np.inf], [0.0, 0.0, 0.0], GRID)
    assert (films >= 2**33).all()  # two lines reach 2**32 steps at most
