"""The twin-disc rig: what it would record, and what records tell."""
