"""The explorer: one page on which a reader moves over a study's operating points."""
