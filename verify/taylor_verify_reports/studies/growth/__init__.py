"""The growth of drift and phase over decades of time."""
