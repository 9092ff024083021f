"""Trajectories that somebody brings, as files or as objects of Python."""
