"""Solvers of other libraries and engines, each a script that runs in an environment of its own."""
