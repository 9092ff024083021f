"""The gates beside solvers that were broken on purpose."""
