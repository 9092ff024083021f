"""Pictures of some motions, and of their errors."""
