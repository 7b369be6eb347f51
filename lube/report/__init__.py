"""The report of a study and the tables of the documentation."""

SUMMARISED = ("lubricant", "film", "contact", "tail", "experiment", "comparison", "gauge")
"""Datasets that the summary of a study uses, as far as the study has them."""
