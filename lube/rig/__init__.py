"""The simulated rig: what it records, and the share of contact in a record."""
