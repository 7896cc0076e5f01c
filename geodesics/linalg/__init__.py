"""Eigenpairs and factorisations of large sparse matrices."""
