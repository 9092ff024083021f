"""Pictures, drawn from plain documents; matplotlib is imported only to draw."""
