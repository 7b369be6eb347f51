"""The archive of a study: making it, checking it, drawing its figures again."""
