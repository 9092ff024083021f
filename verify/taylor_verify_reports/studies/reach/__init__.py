"""The reach of each precision in periods and in extreme values."""
