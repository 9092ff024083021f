"""What a run leaves in a folder: tables and a front page made of its verdicts."""
