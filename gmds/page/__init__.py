"""The parts of the page that `gmds.report` writes."""
