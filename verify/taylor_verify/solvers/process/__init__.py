"""A user's program as a solver: the question on its standard input, a trajectory on its output."""
