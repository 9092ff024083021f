"""Tables and an index that a run leaves in a folder, made of its verdicts."""
