"""Answers to a problem: the solver's contract, heyoka's Taylor integrator, and a callable of one's own."""
