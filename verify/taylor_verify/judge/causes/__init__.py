"""Named hypotheses about wrong dynamics, each tried on the steps from every row of an answer to the next."""
