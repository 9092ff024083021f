"""Pictures of one motion."""
