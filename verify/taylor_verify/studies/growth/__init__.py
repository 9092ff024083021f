"""How drift and phase grow over decades of time."""
