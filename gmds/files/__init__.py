"""Untrusted files (npz, mat, text, values, folders of meshes), and the one writer of tables."""
