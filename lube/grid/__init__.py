"""Operating points, their levels, and the step from SI units to the kernels' whole numbers."""
