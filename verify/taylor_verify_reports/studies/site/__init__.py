"""Static pages of a report folder."""
