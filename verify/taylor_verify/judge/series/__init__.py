"""The judgement of several files of one solver: order of convergence and best step."""
