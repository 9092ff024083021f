"""The equations of motion, each written once, and the rounded problem that a solver receives."""
