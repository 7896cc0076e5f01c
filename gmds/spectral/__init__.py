"""Maps written in eigenfunctions: functional maps, sample maps, refinement, extension to every vertex."""
