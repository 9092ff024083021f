"""Measures of error: errors of states, drifts, balances, shifts of time."""
