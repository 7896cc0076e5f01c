"""One metric a file; each is a function Mesh -> Metric."""
