"""Traps: plain calls of heyoka that go wrong, mostly in silence, beside what the driver does there."""
