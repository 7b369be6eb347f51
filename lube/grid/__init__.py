"""Operating points, their levels, and the step from metres to whole numbers."""
