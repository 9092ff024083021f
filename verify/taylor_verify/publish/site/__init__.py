"""The published folder as a site: static pages that work from a file, with pictures to turn and read."""
