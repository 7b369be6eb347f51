"""Intervals, the scatter of one pair, and curves of probability over the film: plain functions."""
