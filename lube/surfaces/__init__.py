"""Rough surfaces as lines of heights: drawn from a spectrum."""
