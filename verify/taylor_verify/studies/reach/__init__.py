"""The reach of each precision: how far it carries, and where it ends."""
