"""Published measurements of speed against accuracy."""
