"""Named hypotheses about wrong dynamics, tried from row to row of an answer."""
