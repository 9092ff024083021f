"""Measures of error: state, drift, balance, shift of time."""
