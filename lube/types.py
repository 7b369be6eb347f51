"""Short names of types that many signatures share."""

import numpy as np

Array = np.ndarray
Pair = tuple[Array, Array]
Values = float | Array
"""A number or an array; arrays broadcast against one another, labelled ones as well."""
