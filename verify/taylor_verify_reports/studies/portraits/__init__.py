"""Portraits of the shipped scenes: equations, exact motion, numbers of the orbit."""
