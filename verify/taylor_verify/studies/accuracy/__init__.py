"""The verdicts of a run as tables, and the front page of a report."""
