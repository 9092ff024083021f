"""How far each precision carries, and where it ends."""
