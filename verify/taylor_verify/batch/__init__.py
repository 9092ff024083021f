"""Runs of many scenes: on any executor, resumable, with one result object."""
