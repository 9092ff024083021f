"""What is published, one folder each: measure, document, page, picture."""
