"""Short names of types that many signatures share."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

Array = np.ndarray
Datasets = Mapping[str, "xr.Dataset"]
"""Datasets by the names of their kinds."""
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
