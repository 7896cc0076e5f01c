"""Inputs that break programs, given to gmds and to seven libraries."""
