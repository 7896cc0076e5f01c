"""What is on the page that `gmds.report` writes: the parts of it, and what fills them."""
