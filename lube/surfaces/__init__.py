"""Rough surfaces as lines of heights."""
