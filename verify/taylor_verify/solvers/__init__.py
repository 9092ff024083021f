"""Solvers: the contract of a solver, heyoka's Taylor integrator, user-defined callables, and others."""
