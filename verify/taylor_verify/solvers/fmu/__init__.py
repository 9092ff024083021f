"""A simulator exported as an FMU, driven as a solver in a process of its own."""
