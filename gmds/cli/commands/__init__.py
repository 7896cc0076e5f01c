"""One command a file, named as it is called; each has its options and a `command`."""
