"""The judgement of a trajectory file: its conventions, its extent, and how its numbers were stored."""
