"""Loads that a scene writes down, as lists of elementary steps."""
