"""The geometric integrators that a rigid-body specialist asks for first, at a fixed step in float64."""
