"""Speed against accuracy, measured."""
