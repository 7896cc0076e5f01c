"""The version, in a file of its own so that nobody has to import the front door for it."""

__version__ = "0.1.0"
