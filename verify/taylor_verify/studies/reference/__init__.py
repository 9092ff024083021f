"""Exact motions in digits, to test other programs with."""
