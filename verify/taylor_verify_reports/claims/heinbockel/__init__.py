"""Heinbockel, Introduction to Tensor Calculus, page 210: Euler's equations, (2.2.67)-(2.2.72)."""
