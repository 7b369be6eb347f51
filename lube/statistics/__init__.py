"""Confidence and prediction intervals of probabilities, and curves of them against the film."""
