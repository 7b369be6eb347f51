"""What people read of a study: pages, tables, answers."""
