"""Pictures, drawn from plain documents as JSON holds them; matplotlib is imported to draw alone."""
