"""Short names of types that many signatures share."""

import numpy as np

Array = np.ndarray
Pair = tuple[Array, Array]
Points = tuple[int, int]
Ratios = tuple[float, float]
Values = float | Array
"""A number or an array; arrays broadcast against one another, labelled ones as well."""
