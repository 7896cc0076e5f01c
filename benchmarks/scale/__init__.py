"""Large meshes, against named peers."""
