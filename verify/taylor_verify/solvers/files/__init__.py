"""Trajectories from other programs, as files or as Python objects."""
