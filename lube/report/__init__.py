"""The report of a study and the tables of the documentation."""

SUMMARISED = ("lubricant", "film", "contact", "tail", "experiment", "comparison", "gauge")
"""Datasets that the summary of a study uses, as far as the study has them."""
ON_ASSUMPTIONS = ("sensitivity", "record_bands")
"""Datasets, made on request, that say what the assumptions of a study do."""
