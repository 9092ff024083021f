"""What the project costs, in ratios: each of them is taken within one process (`make bench`)."""
