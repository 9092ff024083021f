"""The worst that a search has found, family by family."""
