"""The columns of a trajectory: their names, their units, and which one stands for what."""
