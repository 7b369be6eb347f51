"""A study for others: built, checked, drawn again, explained."""
