"""Typed documents that every room may read, and the names that all rooms share."""
