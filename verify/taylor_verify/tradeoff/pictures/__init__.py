"""Pictures of speed against accuracy."""
