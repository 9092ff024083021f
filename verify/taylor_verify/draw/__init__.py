"""Pictures of one motion: drawn from its exact course, not moving and moving."""
