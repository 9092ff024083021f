"""A plain call of heyoka beside the driver of this suite."""
