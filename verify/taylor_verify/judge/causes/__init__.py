"""Named hypotheses about wrong dynamics, tested from each row of an answer to the next."""
