"""Answers for a notebook: film, contact, what keeps contact rare, and duty cycles."""
