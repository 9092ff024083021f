"""The formats of a trajectory file: each reads its columns as they are, in bounded memory, or refuses."""
