"""Physics of the lubricated contact: plain functions of numbers or arrays, in SI units."""
