"""Likely causes of a failure: faults of a simulator whose own motion is the answer."""
