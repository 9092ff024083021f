"""Common geometric integrators for rigid bodies, at a fixed step in float64."""
