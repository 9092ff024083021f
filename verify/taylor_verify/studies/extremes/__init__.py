"""The hardest scenes, and what was expected of each."""
