"""Short names of types that many signatures share."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

Array = np.ndarray
File = str | Path
"""Path of a file or folder."""
Files = Iterable[File]
Pair = tuple[Array, Array]
"""Two arrays, such as the lines of both rollers or both limits of an interval."""
Points = tuple[int, int]
"""Numbers of grid points, one for each roller."""
Ratios = tuple[float, float]
"""Ratios of speeds, one for each roller."""
Values = float | Array
"""A number or an array, plain or labelled; arrays broadcast against one another."""
