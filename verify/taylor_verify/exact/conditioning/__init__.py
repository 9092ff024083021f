"""The derivative of an exact motion in its data and its state."""
