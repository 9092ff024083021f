"""Hard scenes: their verdicts, the worst that a search finds, and the reach of each precision."""
