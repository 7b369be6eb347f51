"""Measured files, in the formats of the field."""
