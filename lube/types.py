"""Short names of types that many signatures share."""

from pathlib import Path

import numpy as np

Array = np.ndarray
File = str | Path
"""Path of a file or folder."""
Pair = tuple[Array, Array]
Points = tuple[int, int]
Ratios = tuple[float, float]
Values = float | Array
"""A number or an array; arrays broadcast against one another, labelled ones as well."""
