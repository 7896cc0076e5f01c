"""Seconds and memory of matching, of the page, of starting."""
