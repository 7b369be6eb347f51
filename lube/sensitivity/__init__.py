"""Sensitivity of the probability of contact to what a study does not know exactly."""
