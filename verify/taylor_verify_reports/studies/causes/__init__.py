"""The confusion table of likely causes: answers with known faults, and what is said of each."""
