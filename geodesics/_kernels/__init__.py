"""Compiled loops: arrays in, arrays out; a kernel is called like the file that calls it."""
