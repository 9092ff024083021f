"""Conventions of somebody else's columns, found by trying them on the exact motion."""
