"""Each shipped scene: its equations, its exact motion, the numbers of its orbit."""
