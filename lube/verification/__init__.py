"""Checks of the model against exact theory, other methods and printed tables, for any study."""
