"""The documents of what is measured and published, one file for each study."""
