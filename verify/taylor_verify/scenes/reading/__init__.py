"""A scene's text, read into exact numbers; all faults at once."""
