"""The ledger of the two source texts: every statement with its check, as a page."""
