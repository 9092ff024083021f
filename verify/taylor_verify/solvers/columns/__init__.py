"""The columns of a trajectory: usual names, units, and which column of a file is which of ours."""
