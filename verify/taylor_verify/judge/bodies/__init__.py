"""Many free rigid bodies judged at once, in arrays of float64."""
