"""Pictures and animations of one motion, drawn from its exact course."""
