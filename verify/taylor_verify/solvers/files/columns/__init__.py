"""The columns of a trajectory: their names, their units, and their meanings."""
