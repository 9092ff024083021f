"""The ledger of both source texts as a page."""
