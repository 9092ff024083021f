"""The pytest plugin, and what a test may demand of a solver."""
