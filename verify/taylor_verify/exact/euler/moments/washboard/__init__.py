"""A triaxial body under a constant moment: a bead on a tilted washboard, in balls."""
