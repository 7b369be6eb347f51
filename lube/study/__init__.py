"""Studies and lubricant records as people write them in YAML, checked and frozen."""
