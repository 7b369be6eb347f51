"""The simulated rig, and the contact share of a record."""
