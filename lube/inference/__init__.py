"""Inference from records: the model at their conditions, their scatter, factors fitted to them."""
