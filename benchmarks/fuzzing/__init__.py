"""Damaged files and transformed meshes without number."""
