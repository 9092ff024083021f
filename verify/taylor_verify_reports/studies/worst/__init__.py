"""The worst scene of each family, found by a search."""
