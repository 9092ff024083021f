"""Published studies, one folder each: measure, document, page, picture."""
