"""Deliberately defective solvers, each with the gate that must catch it.

A verification suite's own comparison is the first thing that must be able to fail.
"""
