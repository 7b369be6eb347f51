"""A study as people write it in YAML, checked, in frozen values."""
