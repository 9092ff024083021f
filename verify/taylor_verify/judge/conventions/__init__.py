"""Search for the conventions of a file's columns, by comparison with the exact motion."""
