"""Short names of types that many signatures share."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

Array = np.ndarray
File = str | Path
"""Path of a file or folder."""
Files = Iterable[File]
Pair = tuple[Array, Array]
Points = tuple[int, int]
Ratios = tuple[float, float]
Values = float | Array
"""A number or an array; arrays broadcast against one another, labelled ones as well."""
