"""Typed documents that every room may read, and the names that all of them share."""
