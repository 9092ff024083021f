"""What somebody else's columns mean: conventions found by trying them on the exact motion."""
