"""The report of a study and the tables of the documentation."""

SUMMARISED = ("lubricant", "film", "contact", "experiment", "comparison", "gauge")
"""Datasets of which the summary of a study speaks, as far as it has them."""
