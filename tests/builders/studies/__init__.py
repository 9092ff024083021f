"""Small stored studies, as the pages and pictures of each study need them."""
