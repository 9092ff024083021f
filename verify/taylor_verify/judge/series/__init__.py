"""Several files of one solver: order of convergence and best step."""
