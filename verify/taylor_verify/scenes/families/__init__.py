"""Families of scenes: scene files in which some numbers are drawn."""
