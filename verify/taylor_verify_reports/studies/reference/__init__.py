"""Exact motions in digits, for tests of other programs."""
