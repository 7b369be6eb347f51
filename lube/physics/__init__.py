"""Physics of the contact in SI units, plain functions on numbers and arrays."""
