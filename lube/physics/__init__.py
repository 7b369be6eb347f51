"""Physics of the lubricated contact: plain functions of numbers or arrays.

Units are SI, except for the kinematic viscosities of the empirical laws, which are in mm2/s.
"""

ZERO_CELSIUS = 273.15
"""0 degC in K."""
