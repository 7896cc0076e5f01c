"""The page in a browser and the table in a notebook."""

from __future__ import annotations

from geodesics.moved_paths import names_moved
from gmds.moved_paths import MOVED
from gmds.report.page import write_report

__all__ = ["write_report"]


__getattr__ = names_moved(__name__, MOVED[__name__])
