"""Tables and a front page that a run leaves in a folder, made of its verdicts."""
