"""The proven width of an enclosure beside its true error, on two motions."""
