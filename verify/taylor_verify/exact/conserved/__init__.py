"""Conserved quantities of motions under written loads, from exact polynomials that are zero."""
