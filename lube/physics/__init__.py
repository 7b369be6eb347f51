"""Physics of the lubricated contact: plain functions of numbers or arrays, in SI units."""

import numpy as np

Values = float | np.ndarray
"""A number or an array; arrays broadcast against one another, labelled ones as well."""
