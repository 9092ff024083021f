"""The hardest scenes, and the verdicts expected of each."""
