"""The engine board: physics engines measured against the exact motion, and published."""
