"""Sweeps: many scenes solved and judged in chunks, their rows in a dataset that grows part by part."""
