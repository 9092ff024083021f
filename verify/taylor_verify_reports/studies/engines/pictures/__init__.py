"""The pictures of the engine board."""
