"""Files, their origin, and the repository they belong to."""
