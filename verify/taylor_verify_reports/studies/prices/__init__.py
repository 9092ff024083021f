"""The computing time that each option of a scene costs."""
