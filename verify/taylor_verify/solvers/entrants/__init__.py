"""Integrators of other libraries, each a script in an environment of its own."""
