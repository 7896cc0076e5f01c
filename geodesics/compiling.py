"""Kernels are compiled when first used, which takes seconds and happens once on a machine."""

from __future__ import annotations

from geodesics._kernels.jit import cache_folder, reporting_compilation

__all__ = ["cache_folder", "reporting_compilation"]
