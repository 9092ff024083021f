"""Shared builders of the tests: what more than one test module makes, reads or compares."""
