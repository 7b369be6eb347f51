"""The explorer: one page on which a reader chooses among a study's operating points."""

EXPLORED = ("lubricant", "film", "contact", "tail", "master", "trace", "comparison")
"""Datasets that the page shows, as far as the study has them."""
