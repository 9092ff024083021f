"""Runs of many scenes at once: on any executor, resumable, with one result that a program can ask."""
