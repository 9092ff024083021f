"""Numbers that are held exactly, and their enclosures."""
