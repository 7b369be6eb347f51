"""The report of a study and the tables of the documentation."""
