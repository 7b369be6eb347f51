"""Physics of the lubricated contact: plain functions of numbers or arrays, in SI units."""

ZERO_CELSIUS = 273.15
"""0 degC in K."""
